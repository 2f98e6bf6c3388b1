// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "property/path/hostile_path.hpp"
#include "property/planner/creeping.hpp"
#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// No plan creeps: one that does keeps a machine Running for hours without a word.
namespace meridian::test {
namespace {

class Creep : public testing::TestWithParam<Transition> {
 protected:
  [[nodiscard]] SmoothTrace plan(const MachineModel& model,
                                 const std::vector<ClBlock>& blocks) const {
    return plan_smooth(model, blocks, joints_of(model, blocks[0]), {GetParam(), 0, 0}, true);
  }
};

/// The wrist of the 6R robot bends from -10 to 10 deg with its other joints at rest, the tool axis
/// `beside_rad` off the plane in which it would pass the singularity.
std::vector<ClBlock> past_the_wrist(const MachineModel& robot, double beside_rad) {
  constexpr int kBlocks = 60, kBend = 4;
  std::vector<ClBlock> blocks;
  const auto pose = [&](double bend) {
    JointVector q = joints_of(robot, [] {
      ClBlock block;
      block.tip_mm = {863.985488, -8.715574, 243.673731};
      block.axis = {-0.640341609, 0.087155743, 0.763129413};
      return block;
    }());
    q[kBend] = bend;
    return forward(robot, robot.tool_length_mm, q);
  };
  const Vector3 across = pose(-0.17).axis.cross(pose(0.17).axis).normalized();
  for (int n = 0; n <= kBlocks; ++n) {
    const ToolPose at = pose(0.17 * (2.0 * n / kBlocks - 1));
    blocks.push_back(
        cut_block(n, {at.tip, (at.axis + std::tan(beside_rad) * across).normalized()}));
  }
  end_program(blocks);
  return blocks;
}

TEST_P(Creep, IsNowhereOnTheWayPastASingularityOfTheWrist) {
  MachineModel robot = config::load_machine(shipped_file("robot-6r"));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  for (const double beside_deg :
       cases({0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1, 1.0, 5.0})) {
    SCOPED_TRACE(beside_deg);
    const SmoothTrace trace = plan(robot, past_the_wrist(robot, units::rad_from_deg(beside_deg)));
    EXPECT_LT(longest_creep_s(robot, trace), kLongestCreep_s);
    EXPECT_EQ(trace.last.status, PlanStatus::kOk) << static_cast<int>(trace.last.reject.code);
  }
}

TEST_P(Creep, IsNowhereInDrawnPrograms) {
  const auto programs = number_of<std::uint32_t>("MERIDIAN_CREEP_PROGRAMS", kIsTimed ? 6 : 2);
  double longest = 0;
  for (const std::string& name : cases(shipped_machines())) {
    const MachineModel model = config::load_machine(shipped_file(name));
    for (std::uint32_t seed = 1; seed <= programs; ++seed) {
      SCOPED_TRACE(name + ", seed " + std::to_string(seed));
      RandomPrograms draw(seed);
      const auto drawn = draw.program(model, 8);
      longest = std::max(longest, longest_creep_s(model, plan(model, drawn)));
      const auto hostile = HostilePath(seed, 0, 0.4).make_program(1);
      longest = std::max(longest, longest_creep_s(model, plan(model, hostile)));
      ASSERT_LT(longest, kLongestCreep_s);
    }
  }
  std::printf("slower than a thousandth of the feed for %.3f s at most\n", longest);
}

/// Three blocks from rest to rest: one takes its two micrometres in `slow_s`, the others are
/// `length_mm` long.
std::vector<ClBlock> with_a_slow_block(const MachineModel& model, int slow, double length_mm,
                                       double slow_s) {
  const ClBlock begin = RandomPrograms(1).program(model, 1).front();
  const ToolPose at{to_vector(begin.tip_mm), to_vector(begin.axis)};
  std::vector<ClBlock> blocks = {cut_block(0, at)};
  double distance_mm = 0;
  for (int n = 1; n <= 3; ++n) {
    distance_mm += n == slow ? 0.002 : length_mm;
    blocks.push_back(cut_block(n, {at.tip + distance_mm * Vector3::UnitX(), at.axis}));
    if (n != slow) continue;
    blocks.back().feed_meaning = FeedMeaning::kInverseTime;
    blocks.back().feed = 1 / slow_s;
  }
  end_program(blocks);
  return blocks;
}

TEST_P(Creep, IsNowhereBetweenARestAndABlockThatIsSlowByItsOwnWord) {
  double longest = 0;  // beyond what was asked for
  for (const std::string& name : cases(shipped_machines())) {
    const MachineModel model = config::load_machine(shipped_file(name));
    for (const double length_mm : cases({0.007, 0.03, 1.0})) {
      for (int slow = 1; slow <= 3; ++slow) {
        for (const double slow_s : {9.0, 9.63, 10.0}) {  // windows end elsewhere
          SCOPED_TRACE(testing::Message() << name << ", block " << slow << " of " << slow_s
                                          << " s, " << length_mm << " mm");
          const SmoothTrace trace = plan(model, with_a_slow_block(model, slow, length_mm, slow_s));
          EXPECT_EQ(trace.last.status, PlanStatus::kOk) << static_cast<int>(trace.last.reject.code);
          EXPECT_LT(trace.duration_s(), slow_s + 1);
          longest = std::max(longest, trace.duration_s() - slow_s);
        }
      }
    }
  }
  std::printf("%.3f s longer than asked for, at most\n", longest);
}

INSTANTIATE_TEST_SUITE_P(Every, Creep, testing::Values(Transition::kSmooth, Transition::kExactStop),
                         [](const testing::TestParamInfo<Transition>& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::test
