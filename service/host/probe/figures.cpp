// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/figures.hpp"

#include <pthread.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

namespace meridian::probe {
namespace {

constexpr double kNs_per_us = 1000.0;

/// Sorted samples; the smallest one that at least `share` of them do not exceed.
double percentile_us(const std::vector<std::int64_t>& sorted_ns, double share) {
  const auto rank =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted_ns.size())));
  const std::size_t index = std::clamp<std::size_t>(rank, 1, sorted_ns.size()) - 1;
  return static_cast<double>(sorted_ns[index]) / kNs_per_us;
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) {
      return line.substr(line.find(':') + 2);
    }
  }
  return "unknown processor";
}

}  // namespace

Figures figures_of(std::vector<std::int64_t> samples_ns) {
  if (samples_ns.empty()) {
    return {};
  }
  std::sort(samples_ns.begin(), samples_ns.end());
  return {percentile_us(samples_ns, 0.5), percentile_us(samples_ns, 0.99),
          percentile_us(samples_ns, 0.999), percentile_us(samples_ns, 1.0), samples_ns.size()};
}

double median(std::vector<double> values) {
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 != 0) {
    return *middle;
  }
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

std::vector<std::int64_t> with_omitted(const std::vector<std::int64_t>& late_ns,
                                       std::int64_t interval_ns) {
  std::vector<std::int64_t> all;
  all.reserve(late_ns.size());
  for (const std::int64_t late : late_ns) {
    all.push_back(late);
    if (interval_ns <= 0) continue;
    std::int64_t omitted = late - interval_ns;
    for (int i = 0; i < Histogram::kMaxOmitted && omitted > 0; ++i, omitted -= interval_ns) {
      all.push_back(omitted);
    }
  }
  return all;
}

void Turns::add(const std::vector<std::int64_t>& samples_ns, std::int64_t interval_ns) {
  const std::vector<std::int64_t> all = with_omitted(samples_ns, interval_ns);
  turns_.push_back(figures_of(all));
  all_ns_.insert(all_ns_.end(), all.begin(), all.end());
  stalls_ += static_cast<std::size_t>(
      std::count_if(samples_ns.begin(), samples_ns.end(),
                    [](std::int64_t sample) { return sample >= kStall_ns; }));
}

double Turns::median_of(double Figures::*figure) const {
  std::vector<double> values;
  for (const Figures& turn : turns_) {
    if (turn.samples > 0) values.push_back(turn.*figure);
  }
  return median(values);
}

double Turns::median_p50_us() const { return median_of(&Figures::p50_us); }

double Turns::median_p99_us() const { return median_of(&Figures::p99_us); }

Histogram Turns::histogram() const {
  Histogram histogram;
  for (const std::int64_t sample_ns : all_ns_) histogram.record(sample_ns);
  return histogram;
}

std::string Turns::to_text() const {
  const Figures all = figures_of(all_ns_);
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%-28s median of %zu turns: p50 %.1f p99 %.1f us; all: p50 %.1f p99 %.1f p99.9 %.1f "
      "max %.1f us, %zu samples",
      name_.c_str(), turns_.size(), median_p50_us(), median_p99_us(), all.p50_us, all.p99_us,
      all.p999_us, all.max_us, all.samples);
  return text;
}

bool has_realtime_rights() {
  sched_param old_parameters{};
  int old_policy = 0;
  pthread_getschedparam(pthread_self(), &old_policy, &old_parameters);
  const sched_param wanted{.sched_priority = 80};
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) != 0) {
    return false;
  }
  pthread_setschedparam(pthread_self(), old_policy, &old_parameters);
  return true;
}

std::string host_text() {
  utsname system{};
  uname(&system);
  return "host: " + processor_name() + ", " + std::to_string(std::thread::hardware_concurrency()) +
         " cores, " + system.sysname + " " + system.release + ", " +
         (has_realtime_rights() ? "real-time rights" : "no real-time rights: best effort");
}

}  // namespace meridian::probe
