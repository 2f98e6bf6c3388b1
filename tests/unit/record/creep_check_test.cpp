// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/creep_check.hpp"

#include <gtest/gtest.h>

#include "check_fixture.hpp"

namespace meridian::record {
namespace {

class CheckCreep : public test::Check {
 protected:
  /// In the middle of line 5 the machine goes on by `step` of the way to the next row in every one
  /// of `cycles` cycles, plan time by `plan_step_s`.
  void slow_down(std::size_t cycles, double step, double plan_step_s) {
    const std::size_t at = middle_of(5);
    CycleRecord row = records[at];
    const JointVector from = row.joints, to = records[at + 1].joints;
    std::vector<CycleRecord> slow;
    for (std::size_t n = 1; n <= cycles; ++n) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        row.joints[i] = from[i] + step * static_cast<double>(n) * (to[i] - from[i]);
      }
      row.setpoint.velocity = JointVector{};
      row.plan_time_s += plan_step_s;
      slow.push_back(row);
    }
    records.insert(records.begin() + static_cast<std::ptrdiff_t>(at) + 1, slow.begin(), slow.end());
    for (std::size_t n = 0; n < records.size(); ++n) {
      records[n].setpoint.cycle = n;
      records[n].setpoint.due_ns = static_cast<std::int64_t>(n) * model.cycle_ns;
      if (n > at + cycles) records[n].plan_time_s += plan_step_s * static_cast<double>(cycles);
    }
  }

  CheckCreep() {
    lift_joint_limits();
    options.tip_tolerance_mm = 0.01;  // it stops and goes on within a cycle
    options.axis_tolerance_rad = units::rad_from_deg(0.01);
    for (JointSpec& joint : model.joints) joint.limits.velocity = 300;
  }
};

TEST_F(CheckCreep, IsFoundWhereTheMachineRunsAndGetsNowhereForMoreThanTenSeconds) {
  slow_down(11'000, 1e-5, 1e-3);
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kCreep);
  EXPECT_EQ(report.findings[0].line, 5U);
  EXPECT_NE(report.findings[0].text.find("11.0 s"), std::string::npos) << report.findings[0].text;
}

TEST_F(CheckCreep, IsNoneForLessThanThat) {
  slow_down(9'000, 1e-5, 1e-3);
  EXPECT_TRUE(run().passed()) << to_text(run());
}

TEST_F(CheckCreep, IsNoneWherePlanTimeStandsStill) {
  slow_down(11'000, 0, 0);
  EXPECT_TRUE(run().passed()) << to_text(run());
}

TEST_F(CheckCreep, IsNoneWhereAnOverrideIsAsLow) {
  slow_down(11'000, 1e-5, 1e-8);
  EXPECT_TRUE(run().passed()) << to_text(run());
}

TEST_F(CheckCreep, IsFoundWhereJointsDoNotMoveAtAllThoughPlanTimeDoes) {
  slow_down(11'000, 0, 1e-3);
  expect_only(run(), Finding::Kind::kCreep);
}

TEST_F(CheckCreep, CountsAnewWhereAJointTurnsAtAFixedTip) {
  JointVector from{}, to{};
  CreepCheck check(model);
  for (std::uint64_t cycle = 1; cycle < 20'000; ++cycle) {
    to[4] = from[4] + (cycle == 9'500 ? 0.01 : 0.0);
    check.add({from, to, 0, 10, 0, 1}, cycle, 1);
    from = to;
  }
  CheckReport report;
  check.finish(report);
  EXPECT_EQ(report.findings.size(), 1U) << "10.5 s behind it";
  EXPECT_EQ(report.findings[0].cycle, 19'999U);
}

TEST_F(CheckCreep, IsNoneWhereTinyBlocksRestAtEveryVertex) {
  const JointVector rest{};
  CreepCheck check(model);
  for (std::uint64_t cycle = 1; cycle < 30'000; ++cycle) {
    check.add({rest, rest, 0, 10, cycle % 20 == 0 ? 1U : 0U, 1}, cycle, 1);
  }
  CheckReport report;
  check.finish(report);
  EXPECT_TRUE(report.passed());
}

}  // namespace
}  // namespace meridian::record
