// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meridian/cycle/histogram.hpp"

/// Figures of latency samples and how they are printed. Samples are ns, figures µs.
namespace meridian::probe {

inline constexpr std::int64_t kStall_ns = 1'000'000;

struct Figures {
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
  std::size_t samples = 0;
};

/// Percentiles by the nearest rank; all zero where there are no samples.
[[nodiscard]] Figures figures_of(std::vector<std::int64_t> samples_ns);

/// Median of one figure over turns; 0 where there is none.
[[nodiscard]] double median(std::vector<double> values);

/// Latenesses of a thread that wakes every `interval_ns`, with those of the wake-ups that it slept
/// through: value, value - interval, ... down to above 0, as Histogram::record_every() counts them
/// (coordinated omission). Proof: tests/unit/probe/figures_test.cpp.
[[nodiscard]] std::vector<std::int64_t> with_omitted(const std::vector<std::int64_t>& late_ns,
                                                     std::int64_t interval_ns);

/// One kind of measurement, taken in several turns.
class Turns {
 public:
  explicit Turns(std::string name) : name_(std::move(name)) {}

  /// Adds a turn: what a thread measured every `interval_ns` with what it slept through, as
  /// with_omitted() says; 0: samples as they are.
  void add(const std::vector<std::int64_t>& samples_ns, std::int64_t interval_ns = 0);

  [[nodiscard]] std::size_t count() const { return turns_.size(); }
  /// Medians are of the turns that have samples: nothing measured is not fast.
  [[nodiscard]] double median_p50_us() const;
  [[nodiscard]] double median_p99_us() const;
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Of all turns together.
  [[nodiscard]] Figures all() const { return figures_of(all_ns_); }
  [[nodiscard]] Histogram histogram() const;
  [[nodiscard]] std::size_t samples() const { return all_ns_.size(); }
  /// Samples of at least kStall_ns, each once: no scheduler of a healthy host makes a real-time
  /// thread wait that long; the host took the processor away, or a thread above ours did.
  [[nodiscard]] std::size_t stalls() const { return stalls_; }
  /// "NAME: median of N turns p50 .. p99 .. µs; all M samples p50, p99, p99.9, max".
  [[nodiscard]] std::string to_text() const;

 private:
  [[nodiscard]] double median_of(double Figures::*figure) const;

  std::string name_;
  std::vector<Figures> turns_;
  std::vector<std::int64_t> all_ns_;
  std::size_t stalls_ = 0;
};

/// Processor, kernel, cores and whether this process has real-time rights: the line that says where
/// a figure was measured.
[[nodiscard]] std::string host_text();

/// Whether this process may use FIFO priorities and lock memory.
[[nodiscard]] bool has_realtime_rights();

}  // namespace meridian::probe
