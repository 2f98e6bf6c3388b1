// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "service/host/probe/run/drive_side.hpp"

namespace meridian::probe {

/// What the recording of record says about the time of one cycle.
struct CycleTimes {
  std::uint64_t cycle = 0;
  std::int64_t due_ns = 0, woke_ns = 0;
  std::uint64_t lost = 0;            ///< periods before it that nobody executed
  std::int64_t lateness_ns = 0;      ///< actual wake-up minus when the first of these was due
  std::int64_t computation_ns = -1;  ///< reported by the next row, however late; -1: there is none
  bool is_moving = false;            ///< a program, or the approach to it, was on its way
};

/// Reads the times of every row of `recording`, in its order, of a machine with cycles of
/// `period_ns`. Rows that the recording lacks count as lost periods.
[[nodiscard]] std::vector<CycleTimes> read_times(const std::filesystem::path& recording,
                                                 std::int64_t period_ns);

/// A stretch of time on the machine's clock.
struct Window {
  std::int64_t begin_ns = 0, end_ns = 0;
};

/// Of so many there should be, so many are missing.
struct Missing {
  std::uint64_t missing = 0, of = 0;
  [[nodiscard]] double percent() const {
    return of == 0 ? 0 : 100.0 * static_cast<double>(missing) / static_cast<double>(of);
  }
  Missing& operator+=(const Missing& more) {
    missing += more.missing;
    of += more.of;
    return *this;
  }
};

/// What the service did in its turns.
struct TurnFigures {
  /// By turn; a wake-up that slept through periods is one lateness.
  std::vector<std::vector<std::int64_t>> lateness_ns, one_way_ns;
  std::vector<std::int64_t> computation_ns;  ///< of the cycles that moved the machine
  std::uint64_t moving = 0;                  ///< so many there were
  Missing periods;                           ///< nobody executed
  Missing setpoints;                         ///< never came to the drives
  std::uint64_t untimed = 0;  ///< cycles without a row after them: when they computed is unknown
};

/// Adds one turn: the rows of `times` and the setpoints of `arrivals`, both in order of their
/// cycles, that were due in `window`. Proof: tests/unit/probe/turn_figures_test.cpp.
void add_turn(const Window& window, std::int64_t period_ns, const std::vector<CycleTimes>& times,
              const std::vector<DriveSide::Arrival>& arrivals, TurnFigures& figures);

/// The time in which the machine moved, in turns of `turn_ns`; what is left over belongs to the
/// last. Empty where it never did.
[[nodiscard]] std::vector<Window> moving_turns(const std::vector<CycleTimes>& times,
                                               std::int64_t period_ns, std::int64_t turn_ns);

}  // namespace meridian::probe
