// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/cl_block.hpp"
#include "support/machines.hpp"

/// Machines whose C has an end of travel, and blocks that turn it there.
namespace meridian::test {

constexpr double kRetract_mm = 30;  ///< of a rewind

/// Limits as bench_machine(), C between `low_deg` and `high_deg`, rewind off the part.
inline MachineModel limited(MachineModel model, double low_deg, double high_deg) {
  const MachineModel bench = bench_machine();
  for (int i = 0; i < model.joint_count; ++i) {
    const std::string name = model.joints[i].name;
    const bool is_rotary = model.joints[i].is_rotary;
    model.joints[i] = bench.joints[is_rotary ? 4 : 0];
    model.joints[i].name = name;
    model.joints[i].is_rotary = is_rotary;
  }
  JointSpec& c = model.joints[redundant_joint(model)];
  c.is_endless = false;
  c.limits.travel_min = units::rad_from_deg(low_deg);
  c.limits.travel_max = units::rad_from_deg(high_deg);
  model.max_feed_mm_per_s = 1000;
  model.rewind_policy = RewindPolicy::kRetract;
  model.rewind_retract_mm = kRetract_mm;
  return model;
}

/// A fork head: A on C, both on the tool side; joints in the order X Y Z C A.
inline MachineModel fork_machine() {
  MachineModel model;
  model.name = "fork-ca";
  model.family = MachineFamily::kChain;
  const Vector3 o = Vector3::Zero();
  const std::array<ChainJoint, 5> chain{
      ChainJoint{0, false, false, Vector3::UnitX(), o},
      ChainJoint{1, false, false, Vector3::UnitY(), o},
      ChainJoint{2, false, false, Vector3::UnitZ(), o},
      ChainJoint{3, true, false, Vector3::UnitZ(), o},
      ChainJoint{4, true, false, Vector3::UnitX(), Vector3(0, 0, 600)}};
  model.chain = *describe_chain(chain, Vector3::UnitZ(), Vector3(0, 0, 400));
  for (int i = 3; i < 5; ++i) model.joints[i].is_rotary = true;
  model.tool_length_mm = 110;
  return model;
}

/// A cut to `tip` with the axis leaning by `tilt` towards `azimuth`, 100 mm/s.
inline ClBlock leaning(double tilt, double azimuth, const Vector3& tip) {
  ClBlock block;
  block.tip_mm = to_array(tip);
  block.axis = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                std::cos(tilt)};
  block.feed = 100;
  block.feed_meaning = FeedMeaning::kTip;
  return block;
}

/// Joints at the end of `block`, with windings near `reference`.
inline JointVector solve_block(const MachineModel& model, const ClBlock& block, int branch,
                               const JointVector& reference = {}) {
  const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis)};
  return solve(model, model.tool_length_mm, pose, branch, reference).q;
}

}  // namespace meridian::test
