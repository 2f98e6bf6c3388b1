// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "meridian/cycle/jog/probing.hpp"
#include "unit/cycle/program.hpp"

namespace meridian::test {

/// A cut of 200 mm along x that is loaded, and a probe in the spindle.
struct Probed : Program {
  explicit Probed(ProbeInput probe = ProbeInput::kFree, double planned_feed_factor = 1) {
    say(probe);
    plan.set_feed_factor(planned_feed_factor);
    plan.cut({200, 0, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
    EXPECT_TRUE(world.run_until(State::kLoaded, 1));
  }
  void say(ProbeInput probe) { world.in.feedback.probe = probe; }
  void seek(double seconds) {
    world.command(Verb::kStart, kStartProbing);
    world.run_for(seconds);
  }
  void touch() {
    say(ProbeInput::kContact);
    world.run();
  }
  [[nodiscard]] double tip_x(const JointVector& joints) const {
    return forward(machine, machine.tool_length_mm, joints).tip.x();
  }
  /// The joints that the contact was reported with.
  [[nodiscard]] JointVector reported(std::uint64_t is_before) const {
    JointVector joints{};
    for (const Event& event : world.events) {
      const bool is_one = event.code == EventCode::kContactJoint && event.b == is_before;
      if (is_one) joints[event.a] = event.x;
    }
    return joints;
  }
};

}  // namespace meridian::test
