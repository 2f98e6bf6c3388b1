// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// No plan of a robot lets a joint jump: what leads onto, along, off or through its base axis, or
/// closely past it, is planned inside the joints' velocities or refused before it moves.
namespace meridian::test {
namespace {

struct Fastest {
  double share = 0;  ///< of its largest velocity
  int joint = -1;
  std::uint32_t line = 0;
};

/// The fastest joint between two setpoints, 1 ms apart.
Fastest fastest_joint(const MachineModel& model, const Trace& trace, const JointVector& start) {
  constexpr double kStep_s = 1e-3;
  Fastest fastest;
  JointVector before = start;
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    const TimePiece& time = trace.times[n];
    if (!(trace.paths[n].length > 0)) continue;  // dwells, the end
    const int steps = std::clamp(static_cast<int>(time.duration / kStep_s), 1, 200'000);
    const double step_s = time.duration / steps;
    for (int k = 1; k <= steps; ++k) {
      const double s = state_at(time, time.duration * k / steps).s;
      const JointVector q = joints_at(model, trace.paths[n], s, before).q;
      for (int i = 0; i < model.joint_count; ++i) {
        const double room = model.joints[i].limits.velocity * std::max(kStep_s, step_s);
        const double share = std::abs(q[i] - before[i]) / room;
        if (share > fastest.share) fastest = {share, i, time.line};
      }
      before = q;
    }
  }
  return fastest;
}

ClBlock cut_to(const Vector3& tip, std::uint64_t sequence) {
  ClBlock block;
  block.kind = BlockKind::kCut;
  block.tip_mm = to_array(tip);
  block.axis = {0, 0, 1};
  block.feed = 50;
  block.feed_meaning = FeedMeaning::kTip;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence + 1);
  return block;
}

/// The wrist point of a vertical tool is above its tip: the base axis is where x and y are 0.
std::vector<ClBlock> past_the_base_axis(std::uint32_t seed) {
  RandomPrograms draw(seed);
  const double height = 700, beside = draw.chance(0.4) ? 0.0 : draw.log_uniform(1e-10, 30);
  const double from = draw.uniform(20, 60), to = draw.chance(0.3) ? 0.0 : draw.uniform(-60, -5);
  const double turn = draw.uniform(-0.5, 0.5);
  std::vector<Vector3> tips = {{60, beside, height}, {from, beside, height}, {to, beside, height}};
  if (draw.chance(0.5)) tips.emplace_back(to, beside, height - 10);
  tips.emplace_back(draw.uniform(-60, 60), draw.uniform(-60, 60), height);
  std::vector<ClBlock> blocks;
  for (const Vector3& tip : tips) {
    const Vector3 turned(std::cos(turn) * tip.x() - std::sin(turn) * tip.y(),
                         std::sin(turn) * tip.x() + std::cos(turn) * tip.y(), tip.z());
    blocks.push_back(cut_to(turned, blocks.size()));
  }
  end_program(blocks);
  return blocks;
}

/// The first seeds, and those that once drew a jump.
std::vector<std::uint32_t> drawn_seeds() {
  std::vector<std::uint32_t> seeds(number_of<std::uint32_t>("MERIDIAN_JUMP_PROGRAMS", 60));
  std::iota(seeds.begin(), seeds.end(), 1U);
  seeds.insert(seeds.end(), {659, 805, 808, 966, 1233});
  return seeds;
}

class RobotJump : public testing::TestWithParam<Transition> {};

TEST_P(RobotJump, IsNowhereOnOrBesideTheBaseAxis) {
  MachineModel robot = config::load_machine(shipped_file("robot-6r"));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  constexpr int kYaw = 0, kShoulder = 1;
  robot.joints[kYaw].limits.travel_min =
      -(robot.joints[kYaw].limits.travel_max = units::rad_from_deg(200));
  robot.joints[kShoulder].limits.travel_max = units::rad_from_deg(200);
  const auto seeds = drawn_seeds();
  int refused = 0;
  for (const std::uint32_t seed : seeds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto blocks = past_the_base_axis(seed);
    const JointVector start = joints_of(robot, blocks[0]);
    const SmoothTrace trace = plan_smooth(robot, blocks, start, {GetParam(), 0, 0}, true);
    const Fastest fastest = fastest_joint(robot, trace, start);
    ASSERT_LT(fastest.share, 1.01) << "joint " << fastest.joint << ", line " << fastest.line;
    if (trace.last.status == PlanStatus::kRefused) ++refused;
  }
  std::printf("%d of %zu programs refused\n", refused, seeds.size());
  EXPECT_LT(refused, static_cast<int>(seeds.size())) << "nothing is planned at all";
}

INSTANTIATE_TEST_SUITE_P(Every, RobotJump,
                         testing::Values(Transition::kSmooth, Transition::kExactStop),
                         [](const testing::TestParamInfo<Transition>& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::test
