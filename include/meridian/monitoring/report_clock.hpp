// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "meridian/monitoring/monitored.hpp"

namespace meridian::monitoring {

/// Reports come through a network: one that is late by so many periods is no motion.
inline constexpr int kSlackPeriods = 4;

/// How long axis `i` can have moved between two reports: the longer of the time between their
/// arrivals and that of the setpoints which its drive took in between. s.
[[nodiscard]] inline double time_between(double cycle_s, std::int64_t arrival_ns,
                                         std::int64_t arrival_before_ns, std::uint64_t cycle_seen,
                                         std::uint64_t cycle_seen_before) noexcept {
  const double arrived_s = static_cast<double>(arrival_ns - arrival_before_ns) * 1e-9;
  const bool has_taken = cycle_seen_before != 0 && cycle_seen > cycle_seen_before;
  const auto taken = static_cast<double>(has_taken ? cycle_seen - cycle_seen_before : 0);
  return std::max(arrived_s, cycle_s * taken);
}

/// Which axes have a new report, and how far apart in time it is from the one before. The first
/// report after a silence may be as old as that silence was long, and the next one on time: for
/// kGap_s the longest silence, lost periods included, is added. RT: cycle. Proof:
/// tests/unit/monitoring/report_clock_test.cpp.
class ReportClock {
 public:
  static constexpr double kGap_s = 0.1;

  /// Adds one cycle; returns the axes whose report is new, a bit for each. Of the first report of
  /// an axis allowed_s() is 0.
  [[nodiscard]] std::uint32_t add(const Limits& limits, const Inputs& in) noexcept {
    std::uint32_t fresh = 0;
    const double passed_s = limits.cycle_s * in.periods;
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      Axis& axis = axes_[n];
      axis.waited_s += passed_s;
      axis.gap_age_s += passed_s;
      if (in.arrival_ns[n] == axis.arrival_ns) continue;
      fresh |= 1U << n;
      add_report(limits, axis, in.arrival_ns[n], in.cycle_seen[n]);
    }
    return fresh;
  }
  void restart() noexcept { axes_ = {}; }

  /// Time in which axis `i` may have moved since its report before, slack included.
  [[nodiscard]] double allowed_s(std::size_t i) const noexcept { return axes_[i].allowed_s; }

 private:
  struct Axis {
    std::int64_t arrival_ns = 0;
    std::uint64_t cycle_seen = 0;
    double waited_s = 0;              ///< since the newest report
    double gap_s = 0, gap_age_s = 0;  ///< longest silence of late, and how long ago it ended
    double allowed_s = 0;
  };
  static void add_report(const Limits& limits, Axis& axis, std::int64_t arrival_ns,
                         std::uint64_t cycle_seen) noexcept {
    const double gap_s = axis.waited_s - limits.cycle_s;
    if (gap_s >= axis.gap_s || axis.gap_age_s > kGap_s) {
      axis.gap_s = std::max(0.0, gap_s);
      axis.gap_age_s = 0;
    }
    const bool is_first = axis.arrival_ns == 0;
    const double between_s =
        time_between(limits.cycle_s, arrival_ns, axis.arrival_ns, cycle_seen, axis.cycle_seen);
    axis.allowed_s = is_first ? 0 : between_s + axis.gap_s + limits.cycle_s * kSlackPeriods;
    axis.waited_s = 0;
    axis.arrival_ns = arrival_ns;
    axis.cycle_seen = cycle_seen;
  }

  std::array<Axis, kAxes> axes_{};
};

}  // namespace meridian::monitoring
