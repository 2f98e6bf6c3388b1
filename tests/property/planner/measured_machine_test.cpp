// SPDX-License-Identifier: Apache-2.0

/// Machines as they were measured: C misses the tool axis by some seconds of arc. Programs with a
/// vertical tool, through the pole and beside it run as on the drawing's machine. They take a
/// little longer: the vertical tool is beside the pole, at an azimuth of its own, and C turns
/// there.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::test::measured_machine {
namespace {

constexpr double kLimit = 1 + 1e-6, kCycle_s = 1e-3;

/// The machine with the rotary axis next to the workpiece turned by `offset` rad, about b and
/// across.
MachineModel misaligned(MachineModel model, double offset) {
  auto joints = model.chain.chain;
  const Vector3 a = model.chain.a.axis, b = model.chain.b.axis;
  const Vector3 about = (a.cross(b).normalized() + b).normalized();
  for (ChainJoint& joint : joints) {
    if (joint.joint != model.chain.a.joint) continue;
    joint.direction = Eigen::AngleAxisd(offset, about) * joint.direction;
  }
  model.chain = *describe_chain(joints, model.chain.home_axis, model.chain.gauge_mm);
  return model;
}

/// Vertical, tilted by 25 deg and back through the pole to the other side, then vertical again.
std::vector<ClBlock> vertical_and_tilted() {
  std::vector<ClBlock> blocks;
  Vector3 tip(-100, 5, 30);
  for (const double tilt_deg : {0.0, 0.0, 25.0, 0.0, 0.0, -25.0, 0.0, 0.03, -0.03, 0.0, 0.0}) {
    const double tilt = units::rad_from_deg(tilt_deg);
    const Vector3 axis(0.6 * std::sin(tilt), 0.8 * std::sin(tilt), std::cos(tilt));
    blocks.push_back(cut_block(static_cast<int>(blocks.size()), {tip, axis}));
    blocks.back().feed = 40;
    tip[0] += 20;
  }
  end_program(blocks);
  return blocks;
}

/// How far the true tool axis and the tip are from the programmed path, in tolerances.
double farthest_off(const MachineModel& model, const std::vector<ClBlock>& blocks,
                    const SmoothTrace& trace, const std::vector<PlanSample>& setpoints) {
  const auto programmed = programmed_paths(blocks);
  double off = 0;
  for (const PlanSample& setpoint : setpoints) {
    const auto k = static_cast<std::size_t>(setpoint.piece);
    if (trace.times[k].kind != TimeKind::kMove) continue;
    const ToolPose pose = true_pose(model, trace.paths[k].tool_length_mm, setpoint.q);
    off = std::max(off,
                   distance_from(programmed, trace.times[k].sequence, pose, model.tolerances.tip_mm,
                                 model.tolerances.axis_beside_pole_rad(), off));
  }
  return off;
}

class MeasuredMachine : public testing::TestWithParam<std::string> {};

TEST_P(MeasuredMachine, RunsWhatTheOneOfTheDrawingRuns) {
  const MachineModel drawing = config::load_machine(shipped_file(GetParam()));
  const auto blocks = vertical_and_tilted();
  const auto plan_on = [&](const MachineModel& model, Transition how) {
    return plan_smooth(model, blocks, joints_of(model, blocks[0]), {how, 0, 0});
  };
  for (const Transition how : {Transition::kSmooth, Transition::kExactStop}) {
    const double wanted_s = plan_on(drawing, how).duration_s();
    for (const double offset : {2e-5, 1e-4, 3e-4, 1e-3}) {
      SCOPED_TRACE(offset);
      const MachineModel model = misaligned(drawing, offset);
      ASSERT_GT(std::abs(model.chain.pole_offset_rad), 0.5 * offset);
      const SmoothTrace trace = plan_on(model, how);
      ASSERT_NE(trace.last.status, PlanStatus::kRefused) << trace.last.reject.line;
      // 1 mrad leaves less than half of the tolerance beside the pole.
      EXPECT_LT(trace.duration_s(), (offset < 5e-4 ? 1.3 : 2.2) * wanted_s);
      const auto setpoints = sample(model, trace, kCycle_s, 0.37, joints_of(model, blocks[0]));
      const LimitUse use = measure_limits(model, setpoints, kCycle_s);
      EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
      EXPECT_LE(farthest_off(model, blocks, trace, setpoints), kLimit);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Chains, MeasuredMachine,
                         testing::Values("trunnion-ac", "trunnion-bc", "head-table-bc", "fork-ca",
                                         "fork-cb", "nutating-head", "nutating-table"),
                         test_name);

}  // namespace
}  // namespace meridian::test::measured_machine
