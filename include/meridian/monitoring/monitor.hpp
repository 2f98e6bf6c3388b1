// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/monitoring/drive_model.hpp"
#include "meridian/monitoring/mode.hpp"
#include "meridian/monitoring/plausible_feedback.hpp"
#include "meridian/monitoring/position_window.hpp"
#include "meridian/monitoring/report_clock.hpp"
#include "meridian/monitoring/speed_window.hpp"
#include "meridian/monitoring/standstill.hpp"

namespace meridian::monitoring {

/// All monitoring functions of a machine. Feed it once a cycle; it says what it found first, in
/// each cycle in which it finds it. RT: cycle, noexcept, no allocation. Proof:
/// tests/unit/monitoring/, tests/unit/daemon/monitoring_phases_test.cpp.
class Monitor {
 public:
  explicit Monitor(const Limits& limits = {}) noexcept
      : limits_(limits), window_(limits), model_(limits) {}

  [[nodiscard]] Result check(const Inputs& in) noexcept {
    mode_ = mode_tracker_.find(limits_, in);
    sent_.put(in.cycle, in.commanded);
    Result result = check_reports(in);
    const auto add = [&result](const Result& next) {
      if (result.finding == Finding::kNone) result = next;
    };
    add(standstill_.check(limits_, in, mode_));
    add(position_window_.check(limits_, in, mode_));
    return result;
  }

  [[nodiscard]] Mode mode() const noexcept { return mode_; }
  [[nodiscard]] const Limits& limits() const noexcept { return limits_; }

 private:
  /// What reports say in the course of time.
  [[nodiscard]] Result check_reports(const Inputs& in) noexcept {
    // Drives that home renumber their positions.
    if (mode_ == Mode::kOff || in.motion == Motion::kHoming || !in.has_report) {
      clock_.restart();
      plausible_.restart();
      model_.restart();
      window_.restart();
      return {};
    }
    restart_window(in);
    window_.add(in);
    const std::uint32_t fresh = clock_.add(limits_, in);
    const Result plausible = plausible_.check(limits_, sent_, in, clock_, fresh);
    const Result model = model_.check(limits_, sent_, in, fresh);
    if (plausible.finding != Finding::kNone) return plausible;
    const Result fast = check_too_fast(limits_, window_);
    if (fast.finding != Finding::kNone) return fast;
    const Result limited = check_limited_speed(limits_, window_, mode_);
    return limited.finding != Finding::kNone ? limited : model;
  }

  /// What moved fast behind a shut guard does not count for a jog: the window begins anew with the
  /// first set-up mode since the guard opened. After rests between two jogs it goes on.
  void restart_window(const Inputs& in) noexcept {
    if (!in.is_guard_open) is_set_up_ = false;
    if (mode_ != Mode::kSetUp || is_set_up_) return;
    is_set_up_ = true;
    window_.restart();
  }

  Limits limits_;
  ModeTracker mode_tracker_;
  Mode mode_ = Mode::kOff;
  bool is_set_up_ = false;  ///< there was set-up mode since the guard opened
  ReportClock clock_;
  SentPositions sent_;
  Standstill standstill_;
  SpeedWindow window_;
  PositionWindow position_window_;
  DriveModel model_;
  PlausibleFeedback plausible_;
};

}  // namespace meridian::monitoring
