// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "service/host/probe/probe_report.hpp"

namespace meridian::probe {
namespace {

constexpr const char* kColours[] = {"#1f5fa8", "#9dc0e6", "#444444", "#2a9d5c",
                                    "#a8d8ba", "#e08214", "#f4c58d", "#0b2f5b",
                                    "#145c36", "#c22f4f", "#7b4fa3"};

/// Points (latency in µs, share of the samples above it) of one histogram.
void print_shares(std::FILE* out, const Histogram& histogram) {
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) {
    if (histogram.bucket(i) == 0) continue;
    seen += histogram.bucket(i);
    const double above = static_cast<double>(histogram.count() - seen) + 0.5;
    const auto end_ns = std::min(Histogram::bucket_end_ns(i), histogram.max_ns());
    std::fprintf(out, "%.4g %.4g\n", static_cast<double>(std::max<std::int64_t>(end_ns, 1)) * 1e-3,
                 above / static_cast<double>(histogram.count()));
  }
}

void print_field(std::FILE* out, const RateMeasurement& m) {
  std::vector<Shown> shown = distributions(m);
  std::erase_if(shown, [](const Shown& one) { return one.histogram.count() == 0; });
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::fprintf(out, "$d%zu << EOD\n", i);
    print_shares(out, shown[i].histogram);
    std::fputs("EOD\n", out);
  }
  std::fprintf(
      out, "set title %s\nplot ",
      plot::quoted(std::to_string(m.rate_hz) + " Hz" + (m.is_loaded ? ", load" : "")).c_str());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::fprintf(out, "%s$d%zu using 1:2 with lines lw 2 lc rgb '%s' title %s", i > 0 ? ", " : "",
                 i, kColours[i % std::size(kColours)], plot::quoted(shown[i].name).c_str());
  }
  std::fputs("\n", out);
}

}  // namespace

std::optional<plot::PlotError> draw(const ProbeReport& report, const std::string& file) {
  const auto fields = static_cast<int>(report.measurements.size());
  const int columns = fields > 1 ? 2 : 1, rows = (fields + columns - 1) / columns;
  const plot::Sheet sheet{.width = 800 * columns, .height = 80 + 500 * std::max(rows, 1)};
  return plot::draw(file, sheet, [&](std::FILE* out) {
    std::fprintf(out, "set multiplot layout %d,%d title %s\n", rows, columns,
                 plot::quoted(report.host).c_str());
    std::fputs(
        "set logscale xy\nset grid\nset key bottom left\nset xlabel 'us'\n"
        "set ylabel 'share of samples above'\nset format y '10^{%T}'\nset xrange [0.1:*]\n"
        "set yrange [1e-6:1]\n",
        out);
    for (const RateMeasurement& m : report.measurements) print_field(out, m);
  });
}

}  // namespace meridian::probe
