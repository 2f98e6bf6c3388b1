// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "check_fixture.hpp"

/// Where in a recording the cut of its path begins and ends.
namespace meridian::record {
namespace {

using test::Check;
using test::cut_to;
using test::SampleRun;

TEST_F(Check, RefusesAPathThatWasNotFinished) {
  records.resize(middle_of(7));
  CheckReport report = run();
  EXPECT_TRUE(has(report, Finding::Kind::kUnfinished)) << to_text(report);
  options.allow_unfinished = true;
  report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.vertices, 6U);
}

TEST_F(Check, RefusesMotionBehindTheEndOfThePath) {
  std::vector<ClBlock> longer = blocks;
  longer.push_back(cut_to(8, {78.998, -35.996, 20}, 0.25, 30));
  records = SampleRun(model, longer).records;
  expect_only(run(), Finding::Kind::kTip);
}

TEST_F(Check, LeavesALaterProgramAlone) {
  for (CycleRecord record : SampleRun(model, {blocks[0], blocks[1]}).records) {
    record.setpoint.cycle = records.back().setpoint.cycle + 1;
    record.setpoint.due_ns = records.back().setpoint.due_ns + model.cycle_ns;
    record.motion = MotionKind::kApproach;
    const bool is_first = record.setpoint.line == 1;
    if (is_first) record.setpoint.flags = 0;  // the drives are off between the programs
    records.push_back(record);
  }
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_TRUE(report.has_later_program);
}

/// Drives were moved while they were off, after a program: rows at rest go on with its kind.
TEST_F(Check, TakesTheJointsOfDrivesThatAreSwitchedOnElsewhereForNoMotion) {
  std::vector<CycleRecord> all =
      SampleRun(model, {cut_to(1, {80, -40, 60}, 0.3, 200), blocks[0]}).records;
  for (CycleRecord& record : all) record.motion = MotionKind::kApproach;
  for (std::size_t i = 0; i < 19; ++i) all[i].motion = MotionKind::kCut;
  for (std::size_t i = 0; i < 10; ++i) {
    all[i].setpoint.flags = 0;
    all[i].joints[0] += 5;
  }
  for (CycleRecord record : records) {
    record.setpoint.cycle = all.back().setpoint.cycle + 1;
    record.setpoint.due_ns = all.back().setpoint.due_ns + model.cycle_ns;
    all.push_back(record);
  }
  records = all;
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.vertices, 7U);
  EXPECT_FALSE(report.has_later_program);
}

TEST_F(Check, TakesAnApproachThatLeavesThePlaceOfTheBeginForNoCut) {
  records = SampleRun(model, {blocks[0], cut_to(1, {80, -40, 60}, 0.3, 200)}).records;
  for (CycleRecord& record : records) record.motion = MotionKind::kApproach;
  options.allow_unfinished = true;
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
}

TEST_F(Check, TakesAnApproachThatIsBrokenOffBesideTheBeginForNoCut) {
  records = SampleRun(model,
                      {cut_to(1, {80, -40, 60}, 0.3, 200), cut_to(1, {80.0009, -40, 20}, 0.3, 200)})
                .records;
  for (CycleRecord& record : records) record.motion = MotionKind::kApproach;
  options.allow_unfinished = true;
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
}

}  // namespace
}  // namespace meridian::record
