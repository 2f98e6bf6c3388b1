// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// How long one block takes from rest to rest, beside what the feed planner needs for it.
namespace meridian::test {
namespace {

constexpr double kLimit = 1 + 1e-6;

ClBlock cut_to(const ToolPose& pose, double feed_mm_per_s, std::uint64_t sequence) {
  ClBlock block;
  block.kind = BlockKind::kCut;
  block.tip_mm = to_array(pose.tip);
  block.axis = to_array(pose.axis);
  block.feed = feed_mm_per_s;
  block.feed_meaning = FeedMeaning::kTip;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence + 1);
  return block;
}

/// A block between two drawn places inside travel.
struct DrawnBlock {
  std::vector<ClBlock> blocks;
  JointVector start{};

  DrawnBlock(const MachineModel& model, RandomPrograms& draw) {
    JointVector end{};
    const double share = draw.log_uniform(0.01, 0.5);
    for (int i = 0; i < model.joint_count; ++i) {
      const JointLimits& limits = model.joints[i].limits;
      const double reach = model.joints[i].is_rotary ? 1.5 : 1e9;
      const double low = std::max(-reach, 0.8 * limits.travel_min);
      const double high = std::min(reach, 0.8 * limits.travel_max);
      start[i] = draw.uniform(low, high);
      end[i] = std::clamp(start[i] + share * (high - low) * draw.uniform(-1, 1), low, high);
    }
    const double feed = draw.log_uniform(5, 500);
    blocks = {cut_to(forward(model, model.tool_length_mm, start), feed, 0),
              cut_to(forward(model, model.tool_length_mm, end), feed, 1)};
    end_program(blocks);
  }
};

double time_of_cut(const Trace& trace) {
  double sum = 0;
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    if (trace.times[n].kind == TimeKind::kMove && trace.times[n].sequence == 1) {
      sum += trace.times[n].duration;
    }
  }
  return sum;
}

class LegTime : public testing::TestWithParam<std::string> {};

TEST_P(LegTime, OfOneBlockIsThatOfASmoothRun) {
  const auto blocks = number_of<std::uint32_t>("MERIDIAN_LEGS", kIsTimed ? 12 : 3);
  MachineModel model = config::load_machine(shipped_file(GetParam()));
  model.pole_policy = PolePolicy::kExact;
  std::vector<double> ratios;
  double largest = 0;
  for (std::uint32_t seed = 1; seed <= blocks; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomPrograms draw(seed);
    const DrawnBlock one(model, draw);
    const SmoothTrace smooth = plan_smooth(model, one.blocks, one.start, {Transition::kSmooth});
    const SmoothTrace exact = plan_smooth(model, one.blocks, one.start, {Transition::kExactStop});
    if (exact.last.status == PlanStatus::kRefused) continue;
    for (const double cycle : {1e-3, 250e-6}) {
      const auto setpoints = sample(model, exact, cycle, draw.uniform(0, 1), one.start);
      const LimitUse use = measure_limits(model, setpoints, cycle);
      EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
      largest = std::max({largest, use.v, use.a, use.j});
    }
    if (smooth.last.status == PlanStatus::kRefused) continue;
    ratios.push_back(time_of_cut(exact) / time_of_cut(smooth));
  }
  std::sort(ratios.begin(), ratios.end());
  ASSERT_FALSE(ratios.empty());
  std::printf("%zu blocks, exact stop over smooth: %.4f, median %.4f, %.4f; limits %.5f\n",
              ratios.size(), ratios.front(), ratios[ratios.size() / 2], ratios.back(), largest);
  EXPECT_LE(ratios.back(), 1.03);
}

INSTANTIATE_TEST_SUITE_P(Every, LegTime, testing::ValuesIn(shipped_machines()), test_name);

}  // namespace
}  // namespace meridian::test
