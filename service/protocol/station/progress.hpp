// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "meridian/cycle/state.hpp"
#include "service/protocol/time_table.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

/// What a progress bar shows.
struct ProgressView {
  State state = State::kOff;
  std::uint64_t block = 0;        ///< being run
  std::uint64_t block_count = 0;  ///< 0: not known
  std::uint32_t line = 0;
  double feed_programmed_mm_per_min = 0, feed_achieved_mm_per_min = 0;
  bool is_rapid = false;            ///< no feed is programmed for the motion
  bool is_active = false;           ///< from the approach to the last block, stops on the way too
  double fraction = 0;              ///< of the program's ideal time, 0 to 1
  std::optional<double> to_go_s{};  ///< once enough has run for an estimate
};

/// Makes progress out of statuses: time to go is what is left of the ideal time, stretched as much
/// as what has run was. Time is an argument. Proof: tests/unit/protocol/progress_test.cpp.
class ProgressMeter {
 public:
  explicit ProgressMeter(TimeTable times) : times_(std::move(times)) {}

  ProgressView look(const dds::Status& status, std::int64_t now_ns) {
    const double done_s = times_.before(status.block);
    if (has_looked_ && is_running(status.state)) {
      run_s_ += static_cast<double>(now_ns - looked_ns_) * 1e-9;
    }
    if (status.state == State::kApproaching) run_s_ = 0;  // the way there is not the program
    has_looked_ = true;
    looked_ns_ = now_ns;
    ProgressView view{.state = status.state,
                      .block = status.block,
                      .block_count = status.block_count,
                      .line = status.line,
                      .feed_programmed_mm_per_min = status.feed_programmed_mm_per_min,
                      .feed_achieved_mm_per_min = status.feed_achieved_mm_per_min};
    view.is_rapid =
        status.motion == MotionKind::kRapid ||
        (status.motion == MotionKind::kApproach && !(status.feed_programmed_mm_per_min > 0));
    view.is_active = is_active(status.state);
    if (times_.total_s() > 0) view.fraction = done_s / times_.total_s();
    constexpr double kEnough = 0.005;
    if (view.fraction > kEnough && run_s_ > 0) {
      view.to_go_s = run_s_ * (1 - view.fraction) / view.fraction;
    }
    return view;
  }

 private:
  [[nodiscard]] static bool is_running(State state) noexcept {
    return state == State::kRunning || state == State::kStarving || state == State::kHolding;
  }

  [[nodiscard]] static bool is_active(State state) noexcept {
    return state == State::kApproaching || is_running(state) || state == State::kHeld ||
           state == State::kStarved || state == State::kStepping || state == State::kAborting;
  }

  TimeTable times_;
  double run_s_ = 0;
  std::int64_t looked_ns_ = 0;
  bool has_looked_ = false;
};

}  // namespace meridian::stream
