// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  explicit Monitor(const Limits& limits = {}) noexcept : limits_(limits), model_(limits) {}

  [[nodiscard]] Result check(const Inputs& in) noexcept {
    const Mode mode = mode_tracker_.find(limits_, in);
    if (mode != mode_ || !in.has_report) window_.restart();
    mode_ = mode;
    sent_.put(in.cycle, in.commanded);
    Result result = check_reports(in);
    const auto add = [&result](const Result& next) {
      if (result.finding == Finding::kNone) result = next;
    };
    add(standstill_.check(limits_, in, mode));
    add(position_window_.check(limits_, in, mode));
    return result;
  }

  [[nodiscard]] Mode mode() const noexcept { return mode_; }
  [[nodiscard]] const Limits& limits() const noexcept { return limits_; }

 private:
  /// What only a new report can show.
  [[nodiscard]] Result check_reports(const Inputs& in) noexcept {
    // Drives that home give their positions new names.
    if (mode_ == Mode::kOff || in.motion == Motion::kHoming || !in.has_report) {
      clock_.restart();
      plausible_.restart();
      model_.restart();
      return {};
    }
    if (!clock_.take(limits_, in)) return {};
    if (clock_.is_paused()) {
      window_.restart();
    } else {
      window_.add(limits_, in, clock_.elapsed_s());
    }
    const Result plausible =
        plausible_.check(limits_, sent_, in, clock_.elapsed_s(), clock_.is_paused());
    const Result model = model_.check(limits_, sent_, in);
    if (plausible.finding != Finding::kNone) return plausible;
    const Result fast = check_too_fast(limits_, window_);
    if (fast.finding != Finding::kNone) return fast;
    const Result limited = check_limited_speed(limits_, window_, mode_);
    return limited.finding != Finding::kNone ? limited : model;
  }

  Limits limits_;
  ModeTracker mode_tracker_;
  Mode mode_ = Mode::kOff;
  ReportClock clock_;
  SentPositions sent_;
  Standstill standstill_;
  SpeedWindow window_;
  PositionWindow position_window_;
  DriveModel model_;
  PlausibleFeedback plausible_;
};

}  // namespace meridian::monitoring
