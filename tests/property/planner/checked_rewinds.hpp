// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "meridian/path/pose_at.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/program_end.hpp"

/// Checks programs in which C comes to its end of travel.
namespace meridian::test::rewinds {

inline constexpr double kLimit = 1 + 1e-6;

inline std::vector<MachineModel> machines_with_two_solutions() {
  return {limited(lai_machine(), -720, 720), limited(trunnion_machine(), -720, 720),
          limited(fork_machine(), -720, 720)};
}

/// In degrees round a cone.
constexpr double step_of(Transition transition) {
  return transition == Transition::kSmooth ? 4 : 20;
}

/// Where a cone's axis leans to: azimuth and tilt at its corners.
struct Lean {
  double azimuth_deg, tilt_rad;
};

/// From corner to corner in steps of `step_deg` at most.
inline std::vector<ClBlock> lean_along(const std::vector<Lean>& corners, double step_deg) {
  std::vector<ClBlock> blocks;
  const auto add = [&blocks](double azimuth_deg, double tilt) {
    const double at = units::rad_from_deg(azimuth_deg);
    const double height = 0.01 * static_cast<double>(blocks.size());
    blocks.push_back(leaning(tilt, at, {20 * std::cos(at), 20 * std::sin(at), -height}));
  };
  add(corners[0].azimuth_deg, corners[0].tilt_rad);
  for (std::size_t n = 1; n < corners.size(); ++n) {
    const Lean from = corners[n - 1], to = corners[n];
    const double by = to.azimuth_deg - from.azimuth_deg;
    const int steps = static_cast<int>(std::ceil(std::abs(by) / step_deg));
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      add(from.azimuth_deg + by * share, from.tilt_rad + (to.tilt_rad - from.tilt_rad) * share);
    }
  }
  number_and_end(blocks);
  return blocks;
}

/// Turns the path round where C would begin it downwards from `start`.
inline void turn_upwards(const MachineModel& model, const JointVector& start,
                         std::vector<Lean>& corners) {
  const int free = redundant_joint(model);
  const double at = units::rad_from_deg(corners[0].azimuth_deg) + 0.1;
  const Vector3 tip(20 * std::cos(at), 20 * std::sin(at), 0);
  const JointVector next = solve_block(model, leaning(corners[0].tilt_rad, at, tip), 0, start);
  if (next[free] > start[free]) return;
  for (Lean& corner : corners) corner.azimuth_deg *= -1;
}

/// A rewind while its setpoints come: where the tool left, and how far it was off the part.
struct OpenRewind {
  JointVector rest{};  ///< up to a cycle ahead of it
  ToolPose begin{Vector3::Zero(), Vector3::UnitZ()};
  double farthest = 0;
};

/// C alone by whole turns, and only when the tool is off by the whole way.
inline void check_turn_on_branch(const MachineModel& model, OpenRewind& open,
                                 const JointVector& before, const JointVector& now) {
  const int free = redundant_joint(model);
  const ToolPose pose = forward(model, model.tool_length_mm, now);
  const double off = (pose.tip - open.begin.tip).dot(open.begin.axis);
  const double turned = std::abs(now[free] - before[free]);
  // The setpoint before the first may be a cycle short of the rest: 1 µm.
  if (turned > 0 && std::abs(std::remainder(now[free] - open.rest[free], kTurn_rad)) > 5e-6) {
    EXPECT_NEAR(open.farthest, kRetract_mm, 1e-3) << "C turns beside the part";
    for (int i = 0; i < model.joint_count; ++i) {
      if (i == free) continue;
      EXPECT_NEAR(now[i], before[i], 1e-9) << "with C, joint " << i;
    }
    return;
  }
  open.farthest = std::max(open.farthest, off);
  // The last 5e-6 rad of C, 400 mm off its axis.
  EXPECT_LT((pose.tip - open.begin.tip - off * open.begin.axis).norm(), 2e-3);
  EXPECT_LT(angle_between(pose.axis, open.begin.axis), 1e-4);
  EXPECT_GT(off, -1e-3);
}

/// The axis to the pole and back, the tip at rest where the tool is off by the whole way.
inline void check_turn_to_other_branch(const MachineModel& model, OpenRewind& open,
                                       const JointVector& now) {
  const ToolPose pose = forward(model, model.tool_length_mm, now);
  const double off = (pose.tip - open.begin.tip).dot(open.begin.axis);
  EXPECT_LT((pose.tip - open.begin.tip - off * open.begin.axis).norm(), 2e-3);
  EXPECT_GT(off, -1e-3);
  open.farthest = std::max(open.farthest, off);
  const double leans = angle_between(pose.axis, open.begin.axis);
  if (leans < 1e-4) return;
  EXPECT_NEAR(off, kRetract_mm, 1e-3) << "the axis turns beside the part";
  const Vector3 pole = pole_direction(model);
  const auto detour = [&](const Vector3& to) {
    return leans + angle_between(pose.axis, to) - angle_between(open.begin.axis, to);
  };
  EXPECT_LT(std::min(detour(pole), detour(-pole)), 1e-5) << "not straight to the pole";
}

/// The next setpoint is back where the tool left.
inline void check_end(const MachineModel& model, const OpenRewind& open, const Rewind& rewind,
                      const JointVector& now) {
  const int free = redundant_joint(model);
  const ToolPose pose = forward(model, model.tool_length_mm, now);
  EXPECT_LT((pose.tip - open.begin.tip).norm(), 2e-2) << "not where it left";
  EXPECT_NEAR(open.farthest, kRetract_mm, 1e-3);
  EXPECT_NEAR(now[free] - open.rest[free], rewind.turn_rad, 1e-2);
  if (rewind.is_other_branch()) {
    EXPECT_GT(std::abs(std::remainder(rewind.turn_rad, kTurn_rad)), 1) << "no other branch";
  } else {
    EXPECT_NEAR(rewind.turn_rad, rewind.turns * kTurn_rad, 1e-12);
    EXPECT_NE(rewind.turns, 0);
  }
}

/// Checks what was made of `blocks`, the rewinds alone. Returns their number.
inline int check_rewinds(const MachineModel& model, const SmoothTrace& trace,
                         const std::vector<PlanSample>& setpoints) {
  std::size_t count = 0;
  bool was_in = false;
  OpenRewind open;
  for (std::size_t n = 1; n < setpoints.size(); ++n) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const JointVector &before = setpoints[n - 1].q, &now = setpoints[n].q;
    const bool is_in =
        trace.times[k].kind == TimeKind::kMove && trace.paths[k].motion == MotionKind::kRewind;
    if (is_in && !was_in) {
      open = {before, pose_at(trace.paths[k], 0.0), 0};
      if (++count > trace.rewinds.size()) return static_cast<int>(count);
    }
    if (is_in && trace.rewinds[count - 1].is_other_branch()) {
      check_turn_to_other_branch(model, open, now);
    } else if (is_in) {
      check_turn_on_branch(model, open, before, now);
    } else if (was_in) {
      check_end(model, open, trace.rewinds[count - 1], now);
    }
    was_in = is_in;
  }
  return static_cast<int>(count);
}

/// Of all programs that were checked: rewinds, and the most of the limits and in tolerances.
struct Found {
  int rewinds = 0;
  double v = 0, a = 0, j = 0, off = 0;
};

/// Checks what was made of `blocks`: travel, limits, feed, the distance from the programmed path
/// off approaches and rewinds, these by themselves, and that the program ends at its last cut.
inline void check(const MachineModel& model, const SmoothTrace& trace,
                  const std::vector<ClBlock>& blocks, const JointVector& start, Found& found) {
  ASSERT_EQ(trace.last.status, PlanStatus::kOk)
      << "code " << static_cast<int>(trace.last.reject.code) << " joint " << trace.last.reject.joint
      << " block " << trace.last.reject.sequence << " at " << trace.last.reject.value;
  ASSERT_EQ(trace.times.back().kind, TimeKind::kEnd);
  const auto programmed = programmed_paths(blocks);
  const auto setpoints = sample(model, trace, 1e-3, 0.37, start);
  const LimitUse use = measure_limits(model, setpoints, 1e-3);
  EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  EXPECT_LE(measure_feed(model, trace, setpoints, 1e-3), 1.0001);
  for (std::size_t n = 3; n + 3 < setpoints.size(); ++n) {
    ASSERT_LT(first_joint_outside_travel(model, setpoints[n].q, 1e-9), 0) << "setpoint " << n;
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const PathPiece& path = trace.paths[k];
    if (n % 11 != 0 || trace.times[k].kind != TimeKind::kMove) continue;
    if (path.motion == MotionKind::kApproach || path.motion == MotionKind::kRewind) continue;
    const ToolPose pose = forward(model, path.tool_length_mm, setpoints[n].q);
    const double off = distance_from(programmed, trace.times[k].sequence, pose,
                                     model.tolerances.tip_mm, model.tolerances.axis_rad);
    ASSERT_LE(off, kLimit) << "setpoint " << n << " block " << trace.times[k].sequence;
    found.off = std::max(found.off, off);
  }
  const int rewinds = check_rewinds(model, trace, setpoints);
  EXPECT_EQ(rewinds, static_cast<int>(trace.rewinds.size()));
  found.rewinds += rewinds;
  found.v = std::max(found.v, use.v);
  found.a = std::max(found.a, use.a);
  found.j = std::max(found.j, use.j);
  const ToolPose end = forward(model, model.tool_length_mm, trace.joints);
  EXPECT_LE((end.tip - to_vector(blocks[blocks.size() - 2].tip_mm)).norm(), 2e-6);
}

}  // namespace meridian::test::rewinds
