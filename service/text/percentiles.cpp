// SPDX-License-Identifier: Apache-2.0
#include "service/text/percentiles.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "service/text/printed.hpp"

namespace meridian::text {
namespace {

constexpr double kUs = 1e-3;
constexpr int kStepsPerHalving = 5;

/// Standard deviation, every value taken at the end of its bucket, ns.
[[nodiscard]] double deviation_ns(const Histogram& histogram) {
  double sum = 0;
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) {
    const double off = static_cast<double>(Histogram::bucket_end_ns(i)) - histogram.mean_ns();
    sum += static_cast<double>(histogram.bucket(i)) * off * off;
  }
  return histogram.count() == 0 ? 0 : std::sqrt(sum / static_cast<double>(histogram.count()));
}

/// The next level to report: a fifth of the half of what is left above `percent`. In per cent, as
/// HdrHistogram reckons: steps of a tenth would not meet its levels bit for bit.
[[nodiscard]] double next_percent(double percent) {
  const double halvings = std::floor(std::log2(100 / (100 - percent))) + 1;
  return percent + 100 / (std::exp2(halvings) * kStepsPerHalving);
}

}  // namespace

std::string percentile_table(const Histogram& histogram) {
  std::string out = "       Value     Percentile TotalCount 1/(1-Percentile)\n\n";
  const auto total = static_cast<double>(histogram.count());
  const auto line = [&out](double value_ns, double share, std::uint64_t seen) {
    append(out, "%12.3f %2.12f %10llu", value_ns * kUs, share, Count{seen});
    if (share < 1) append(out, " %14.2f", 1 / (1 - share));
    out += '\n';
  };
  std::uint64_t seen = 0;
  double wanted_percent = 0;
  for (std::size_t i = 0; i < Histogram::kBuckets && seen < histogram.count(); ++i) {
    if (histogram.bucket(i) == 0) continue;
    seen += histogram.bucket(i);
    const std::int64_t value_ns = std::min(Histogram::bucket_end_ns(i), histogram.max_ns());
    const double percent = 100 * static_cast<double>(seen) / total;
    const bool is_last = seen == histogram.count();  // one level is reported of it, then 100 %
    for (bool is_reported = false; wanted_percent <= percent && !(is_last && is_reported);
         is_reported = true) {
      line(static_cast<double>(value_ns), wanted_percent / 100, seen);
      wanted_percent = next_percent(wanted_percent);
    }
  }
  if (histogram.count() > 0) {
    line(static_cast<double>(histogram.max_ns()), 1, histogram.count());
  }
  append(out, "#[Mean    = %12.3f, StdDeviation   = %12.3f]\n", histogram.mean_ns() * kUs,
         deviation_ns(histogram) * kUs);
  append(out, "#[Max     = %12.3f, Total count    = %12llu]\n",
         static_cast<double>(histogram.max_ns()) * kUs, Count{histogram.count()});
  append(out, "#[Buckets = %12d, SubBuckets     = %12zu]\n",
         Histogram::kTopBits - Histogram::kSubBits + 1, Histogram::kSub);
  return out;
}

std::string percentile_file_name(const std::string& name) {
  std::string file;
  for (const char c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
    if (is_plain || c == ' ') file += is_plain ? c : '-';
  }
  return file + ".hgrm";
}

}  // namespace meridian::text
