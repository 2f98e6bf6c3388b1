// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "meridian/monitoring/monitored.hpp"

namespace meridian::monitoring {

/// Reports come through a network: one that is late by so many periods is no motion.
inline constexpr int kSlackPeriods = 4;

/// Which reports are new, and how much time lies between two of them: the longest that the clock of
/// arrival, the setpoints that were taken, and the cycles in between say. After lost periods
/// reports may come in any rhythm; `is_paused()` for a while. RT: cycle. Proof:
/// tests/unit/monitoring/report_clock_test.cpp.
class ReportClock {
 public:
  static constexpr double kPause_s = 0.1;

  /// Takes one cycle; true where its report is new. Of the first report elapsed_s() is 0.
  bool take(const Limits& limits, const Inputs& in) noexcept {
    waited_s_ += limits.cycle_s * in.periods;
    pause_s_ = in.periods > 1 ? kPause_s : std::max(0.0, pause_s_ - limits.cycle_s);
    if (!in.has_report || in.arrival_ns == arrival_ns_) return false;
    const bool is_first = arrival_ns_ == 0;
    const double arrival_s = static_cast<double>(in.arrival_ns - arrival_ns_) * 1e-9;
    const double taken_s = in.cycle_seen > cycle_seen_
                               ? limits.cycle_s * static_cast<double>(in.cycle_seen - cycle_seen_)
                               : 0;
    elapsed_s_ = is_first ? 0 : std::max({arrival_s, cycle_seen_ != 0 ? taken_s : 0, waited_s_});
    waited_s_ = 0;
    arrival_ns_ = in.arrival_ns;
    cycle_seen_ = in.cycle_seen;
    return true;
  }
  void restart() noexcept { *this = {}; }

  [[nodiscard]] double elapsed_s() const noexcept { return elapsed_s_; }
  [[nodiscard]] bool is_paused() const noexcept { return pause_s_ > 0; }

 private:
  std::int64_t arrival_ns_ = 0;
  std::uint64_t cycle_seen_ = 0;
  double waited_s_ = 0, elapsed_s_ = 0, pause_s_ = 0;
};

}  // namespace meridian::monitoring
