// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "property/planner/smooth_trace.hpp"

/// Programs that come to the smooth planner block by block, as they come to planner_thread.
namespace meridian::test {

/// What came of a stream.
struct StreamOutcome {
  SmoothTrace trace;
  std::vector<FeedMark> marks;
  std::size_t stuck_at = 0;  ///< block that never found room; 0: none
};

/// A planner at its port: a block that finds no room is offered again, and the port is read
/// meanwhile.
struct BlockStream {
  /// `replayed`: marks of another run.
  BlockStream(const MachineModel& model, const JointVector& start, Transition transition,
              const std::vector<FeedMark>* replayed = nullptr)
      : planner(model) {
    if (replayed != nullptr) planner.replay_feed(*replayed);
    planner.begin(start, model.tool_length_mm, 0, {transition, 0, 0});
  }

  /// Offers `block` and takes what the planner tells of it. `runs_dry` lets the machine enter a
  /// tail; `around` is given each call of the planner, and makes it. False where the block was
  /// refused or never found room.
  template <class Around>
  bool offer(const ClBlock& block, bool runs_dry, const Around& around) {
    constexpr int kTries = 3000;
    for (int tries = 0;; ++tries) {
      around([&] { outcome.trace.last = planner.plan(block, writer); });
      if (outcome.trace.last.status != PlanStatus::kNoRoom) break;
      read(runs_dry);
      if (tries > kTries) {
        outcome.stuck_at = block.sequence;
        break;
      }
    }
    pop_reported();
    return outcome.trace.last.status == PlanStatus::kOk;
  }
  bool offer(const ClBlock& block, bool runs_dry = false) {
    return offer(block, runs_dry, [](const auto& call) { call(); });
  }

  /// No block comes for a while.
  void stall() {
    planner.look_no_further();
    (void)planner.advance(writer);
  }

  void read(bool runs_dry = false) { reader.read(outcome.trace, runs_dry); }

  /// Runs what is planned to its end.
  [[nodiscard]] StreamOutcome end() {
    pop_reported();
    read(true);
    return std::move(outcome);
  }

  void pop_reported() {
    for (FeedMark mark; planner.take_feed_mark(mark);) outcome.marks.push_back(mark);
    for (Rewind one; planner.take_rewind(one);) outcome.trace.rewinds.push_back(one);
    for (RelaxedAxis one; planner.take_relaxed_axis(one);)
      outcome.trace.relaxed_axes.push_back(one);
  }

  std::unique_ptr<MotionPort> port = std::make_unique<MotionPort>();
  MotionWriter writer{*port};
  PatientReader reader{*port};
  SmoothPlanner planner;
  StreamOutcome outcome;
};

}  // namespace meridian::test
