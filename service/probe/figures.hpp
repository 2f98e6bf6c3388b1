// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meridian/rt/histogram.hpp"

/// Figures of latency samples and how they are printed. Samples are ns, figures µs.
namespace meridian::probe {

inline constexpr std::int64_t kStall_ns = 1'000'000;

struct Figures {
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
  std::size_t samples = 0;
};

/// Percentiles by the nearest rank; all zero where there are no samples.
[[nodiscard]] Figures figures_of(std::vector<std::int64_t> samples_ns);

/// Median of one figure over turns.
[[nodiscard]] double median(std::vector<double> values);

/// One kind of measurement, taken in several turns.
class Turns {
 public:
  explicit Turns(std::string name) : name_(std::move(name)) {}

  void add(const std::vector<std::int64_t>& samples_ns);

  [[nodiscard]] std::size_t count() const { return turns_.size(); }
  [[nodiscard]] double median_p50_us() const;
  [[nodiscard]] double median_p99_us() const;
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Of all turns together.
  [[nodiscard]] Figures all() const { return figures_of(all_ns_); }
  [[nodiscard]] Histogram histogram() const;
  /// Samples of at least kStall_ns: no scheduler of a healthy host makes a real-time thread wait
  /// that long; the host took the processor away, or a thread above ours did.
  [[nodiscard]] std::size_t stalls() const;
  /// "NAME: median of N turns p50 .. p99 .. µs; all M samples p50, p99, p99.9, max".
  [[nodiscard]] std::string to_text() const;

 private:
  std::string name_;
  std::vector<Figures> turns_;
  std::vector<std::int64_t> all_ns_;
};

/// Processor, kernel, cores and whether this process has real-time rights: the line that says where
/// a figure was measured.
[[nodiscard]] std::string host_text();

/// Whether this process may use FIFO priorities and lock memory.
[[nodiscard]] bool has_realtime_rights();

}  // namespace meridian::probe
