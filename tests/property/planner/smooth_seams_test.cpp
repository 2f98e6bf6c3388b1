// SPDX-License-Identifier: Apache-2.0

/// Where a run ends, and what follows it goes on or is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "property/planner/smooth_trace.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::smooth_seams {
namespace {

constexpr double kLimit = 1 + 1e-6;

/// A program block by block, with its end; feeds in mm/s.
class Script {
 public:
  Script& cut(const Vector3& tip, const Vector3& axis, double feed = 100) {
    ClBlock block;
    block.sequence = blocks_.size();
    block.tip_mm = to_array(tip);
    block.axis = to_array(axis.normalized());
    block.feed = feed;
    block.feed_meaning = FeedMeaning::kTip;
    blocks_.push_back(block);
    return *this;
  }
  Script& rapid(const Vector3& tip, const Vector3& axis) {
    cut(tip, axis, 0);
    blocks_.back().kind = BlockKind::kRapid;
    blocks_.back().feed_meaning = FeedMeaning::kNone;
    return *this;
  }
  Script& dwell(double seconds) {
    ClBlock block;
    block.sequence = blocks_.size();
    block.kind = BlockKind::kDwell;
    block.value = seconds;
    blocks_.push_back(block);
    return *this;
  }
  [[nodiscard]] std::vector<ClBlock> blocks() const {
    auto out = blocks_;
    end_program(out);
    return out;
  }

 private:
  std::vector<ClBlock> blocks_;
};

/// Cells of a slow cut are many: its end is seen only when those in front are planned.
TEST(SmoothSeams, RefusesWhatLeavesTravelAtTheEndOfASlowCut) {
  MachineModel model = bench_machine();
  const Vector3 up = Vector3::UnitZ(), from(0, 20, 0);
  Script script;
  for (int n = 0; n <= 12; ++n) script.cut(from + Vector3(1.5 * n, 0, 0), up, 1.0);
  const auto blocks = script.blocks();
  model.joints[0].limits.travel_max = 17;  // b3 is x of the table, which does not turn here
  const auto trace = plan_smooth(model, blocks, joints_of(model, blocks[0]));
  ASSERT_EQ(trace.last.status, PlanStatus::kRefused);
  EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
  EXPECT_EQ(trace.last.reject.joint, 0);
  EXPECT_NEAR(static_cast<double>(trace.last.reject.sequence), 12, 1);
}

/// A run that ends a hundredth of a degree beside the pole is relaxed onto it: C stands anywhere.
TEST(SmoothSeams, GoesOnFromWhereARunEndedBesideThePole) {
  const Vector3 tilted(std::sin(0.26), 0, std::cos(0.26)), beside(1.2e-4, 1.2e-4, 1);
  for (const MachineModel& model : {bench_machine(), lai_machine()}) {
    for (const bool has_dwell : {false, true}) {
      SCOPED_TRACE(testing::Message() << model.name << (has_dwell ? " with a dwell" : ""));
      Script script;
      script.cut({0, 20, 0}, tilted).cut({20, 20, 0}, tilted).cut({40, 20, 0}, beside);
      if (has_dwell) script.dwell(0.1);
      script.cut({50, 20, 0}, beside).cut({60, 30, 0}, beside).cut({80, 30, 0}, tilted);
      const auto blocks = script.blocks();
      const JointVector start = joints_of(model, blocks[0]);
      const auto trace = plan_smooth(model, blocks, start);
      ASSERT_EQ(trace.last.status, PlanStatus::kOk)
          << static_cast<int>(trace.last.reject.code) << " block " << trace.last.reject.sequence;
      const LimitUse use = measure_limits(model, sample(model, trace, 1e-3, 0.37, start), 1e-3);
      EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
    }
  }
}

TEST(SmoothSeams, GoesOnBehindABlockTooShortToBeCut) {
  const MachineModel model = bench_machine();
  const Vector3 tilted(std::sin(0.3), 0, std::cos(0.3));
  Script script;
  script.cut({0, 20, 0}, tilted).cut({10, 20, 0}, tilted).cut({10.0000005, 20, 0}, tilted);
  script.rapid({30, 20, 20}, tilted);
  const auto blocks = script.blocks();
  const JointVector start = joints_of(model, blocks[0]);
  const auto trace = plan_smooth(model, blocks, start);
  ASSERT_EQ(trace.last.status, PlanStatus::kOk)
      << static_cast<int>(trace.last.reject.code) << " block " << trace.last.reject.sequence;
}

}  // namespace
}  // namespace meridian::test::smooth_seams
