// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check_fixture.hpp"

namespace meridian::record {
namespace {

using test::Check;
using test::cut_to;
using test::path_of;
using test::SampleRun;
using test::Scratch;

TEST_F(Check, PassesATrueRecordingAndSaysHowNearTheLimitsItWas) {
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_LT(report.tip_mm.value, 1e-9);
  EXPECT_LT(report.tip_between_mm.value, 1e-6);
  EXPECT_LT(report.vertex_mm.value, 1e-9);
  EXPECT_EQ(report.vertices, 7U);
  EXPECT_NEAR(report.feed.value, 0.9, 0.01);
  EXPECT_EQ(report.rows, records.size());
  EXPECT_EQ(report.missing, 0U);
  EXPECT_EQ(report.begin_cycle, records[19].setpoint.cycle);
  EXPECT_EQ(report.end_cycle, records[records.size() - 21].setpoint.cycle);
  EXPECT_GT(report.joints[0].jerk.value, 0.01);
  EXPECT_LT(report.joints[0].jerk.value, 1);
  EXPECT_LT(report.sent_velocity.value, 1);
  EXPECT_NE(to_text(report).find("PASS\n"), std::string::npos);
  EXPECT_NE(to_json(report).find("\"passed\": true"), std::string::npos);
}

TEST_F(Check, RefusesATipTwoMicrometresOff) {
  const std::size_t middle = middle_of(5);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(middle)) / 60.0;
    if (std::abs(x) < 1) {  // b4 moves the tip alone; smooth, so that no joint limit sees it
      records[i].joints[2] += 0.002 * std::pow(1 - x * x, 4);
      records[i].setpoint.velocity[2] += 0.002 * 4 * std::pow(1 - x * x, 3) * -2 * x / 0.060;
    }
  }
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kTip);
  EXPECT_NEAR(report.tip_mm.value, 0.002, 2e-4) << "what lies across the path of line 5";
  EXPECT_EQ(report.findings[0].line, 5U);
}

TEST_F(Check, RefusesAToolAxisOffTheGreatCircle) {
  const std::size_t middle = middle_of(7);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(middle)) / 40.0;
    if (std::abs(x) >= 1) continue;
    const ToolPose pose = forward(model, model.tool_length_mm, records[i].joints);
    const double off = units::rad_from_deg(0.003) * std::pow(1 - x * x, 4);
    const ToolPose tilted{pose.tip, (pose.axis + off * pose.axis.unitOrthogonal()).normalized()};
    records[i].joints = solve(model, model.tool_length_mm, tilted, 0, records[i].joints).q;
  }
  const CheckReport report = run();
  EXPECT_TRUE(has(report, Finding::Kind::kAxis)) << to_text(report);
  EXPECT_FALSE(has(report, Finding::Kind::kTip)) << to_text(report);
}

TEST_F(Check, RefusesAJerkSpikeThatNoToleranceSees) {
  const std::size_t at = middle_of(2);
  records[at].joints[0] += 0.0005;
  const CheckReport report = run();
  EXPECT_TRUE(has(report, Finding::Kind::kJerk)) << to_text(report);
  EXPECT_FALSE(has(report, Finding::Kind::kTip)) << to_text(report);
  const double wanted = 3 * 0.0005 / 1e-9 / model.joints[0].limits.jerk;
  EXPECT_NEAR(report.joints[0].jerk.value, wanted, 0.5);
}

TEST_F(Check, ChecksNoJumpOfDrivesWhoseHomingIsGivenUp) {
  const std::size_t end = records.size();
  for (std::size_t i = end - 5; i < end; ++i) records[i].joints[0] += 0.1;
  EXPECT_TRUE(has(run(), Finding::Kind::kJerk)) << "a jump is one";
  for (std::size_t i = end - 12; i < end; ++i) {
    records[i].state = i < end - 8 ? State::kHoming : State::kAborting;
  }
  const CheckReport report = run();  // the tip is checked as ever: the jump leaves this path
  EXPECT_FALSE(has(report, Finding::Kind::kJerk)) << to_text(report);
  EXPECT_FALSE(has(report, Finding::Kind::kVelocity)) << to_text(report);
}

TEST_F(Check, RefusesVelocityAndAccelerationAboveTheLimit) {
  model.joints[1].limits.velocity = 2;
  EXPECT_TRUE(has(run(), Finding::Kind::kVelocity));
  model.joints[1].limits.velocity = 300;
  model.joints[1].limits.acceleration = 100;
  EXPECT_TRUE(has(run(), Finding::Kind::kAcceleration));
}

TEST_F(Check, ChecksFaultStopRowsByTheirOwnLimits) {
  model.joints[1].limits.acceleration = 100;
  for (CycleRecord& record : records) record.setpoint.flags |= kSetpointFaultStop;
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.fault_stop_cycles, records.size());
}

TEST_F(Check, ChecksADryRunAsAnyOtherAndSaysThatItWasOne) {
  for (CycleRecord& record : records) record.setpoint.flags = kSetpointDry | kSetpointDryEnabled;
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.dry_cycles, records.size());
  EXPECT_NE(to_text(report).find("dry run "), std::string::npos);
  EXPECT_EQ(report.dry_cut_cycles, report.end_cycle - report.begin_cycle + 1);
  EXPECT_NE(to_text(report).find("the cut checked is of a dry run"), std::string::npos);
  model.joints[1].limits.velocity = 2;
  EXPECT_TRUE(has(run(), Finding::Kind::kVelocity));
}

TEST_F(Check, RefusesADryRunAndTheCutBehindItInOneRecordingAndChecksEitherByItself) {
  const std::vector<CycleRecord> cut = records;
  for (CycleRecord& record : records) record.setpoint.flags = kSetpointDry | kSetpointDryEnabled;
  const std::uint64_t count = records.size();
  for (CycleRecord record : cut) {
    record.setpoint.cycle += count;
    record.setpoint.due_ns += static_cast<std::int64_t>(count) * model.cycle_ns;
    records.push_back(record);
  }
  EXPECT_TRUE(has(run(), Finding::Kind::kDryAndFollowed));
  const std::uint64_t first_cut = cut.front().setpoint.cycle + count;
  options.from_cycle = first_cut;
  const CheckReport real = run();
  EXPECT_TRUE(real.passed()) << to_text(real);
  EXPECT_EQ(real.dry_cut_cycles, 0U);
  EXPECT_EQ(to_text(real).find("dry run"), std::string::npos) << to_text(real);
  options.from_cycle = 0;
  options.to_cycle = first_cut - 1;
  const CheckReport dry = run();
  EXPECT_TRUE(dry.passed()) << to_text(dry);
  EXPECT_EQ(dry.dry_cycles, count);
}

TEST_F(Check, RefusesASkippedVertexThoughEveryPoseIsOnThePath) {
  std::vector<ClBlock> shortened = blocks;
  shortened.erase(shortened.begin() + 2, shortened.begin() + 4);  // never out to 82.02
  records = SampleRun(model, shortened).records;
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kVertex);
  EXPECT_EQ(report.findings[0].line, 3U);
  EXPECT_NEAR(report.vertex_mm.value, 0.02, 1e-6);
}

TEST_F(Check, RefusesACutCorner) {
  std::vector<ClBlock> cut = blocks;
  cut[4] = cut_to(5, {81.99, -37.01, 19.003}, 0.35, 30);
  records = SampleRun(model, cut).records;
  const CheckReport report = run();
  EXPECT_TRUE(has(report, Finding::Kind::kTip)) << to_text(report);
  EXPECT_TRUE(has(report, Finding::Kind::kVertex)) << to_text(report);
}

TEST_F(Check, PassesACornerThatIsCutInsideALargeTolerance) {
  lift_joint_limits();
  options.tip_tolerance_mm = 0.3;
  blocks = {cut_to(1, {80, -40, 20}, 0.3, 30), cut_to(2, {82, -40, 20}, 0.3, 30),
            cut_to(3, {82, -37, 20}, 0.3, 30)};
  for (const double off : {0.1, 0.2, 0.4}) {
    records = SampleRun(model, {blocks[0], cut_to(2, {82 - off, -40, 20}, 0.3, 30),
                                cut_to(2, {82, -40 + off, 20}, 0.3, 30), blocks[2]})
                  .records;
    const CheckReport report = run();
    EXPECT_TRUE(report.passed()) << to_text(report);
    EXPECT_NEAR(report.vertex_mm.value, off / std::numbers::sqrt2, 1e-4);
  }
  records = SampleRun(model, {blocks[0], cut_to(2, {81.5, -40, 20}, 0.3, 30),
                              cut_to(2, {82, -39.5, 20}, 0.3, 30), blocks[2]})
                .records;
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kVertex);
  EXPECT_NEAR(report.vertex_mm.value, 0.5 / std::numbers::sqrt2, 1e-4) << "off the vertex";
}

/// To and fro with the axis at a fixed tip, and to and fro with the tip along a line.
[[nodiscard]] std::vector<ClBlock> turning_blocks(double tilt, double out_mm) {
  return {cut_to(1, {80, -40, 20}, 0.3, 30),          cut_to(2, {82, -40, 20}, 0.3, 30),
          cut_to(3, {82, -40, 20}, tilt, 30),         cut_to(4, {82, -40, 20}, 0.3, 30),
          cut_to(5, {82, -40, 20}, tilt, 30),         cut_to(6, {82, -40, 20}, 0.3, 30),
          cut_to(7, {82 + out_mm, -40, 20}, 0.3, 30), cut_to(8, {82, -40, 20}, 0.3, 30),
          cut_to(9, {82, -37, 19}, 0.3, 30)};
}

TEST_F(Check, PassesAToolThatTurnsRoundInsideTheTolerances) {
  lift_joint_limits();
  options.tip_tolerance_mm = 0.01;
  options.axis_tolerance_rad = units::rad_from_deg(0.1);
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    SCOPED_TRACE(share);
    for (const double turn : {0.05, 0.01, -0.05}) {
      blocks = turning_blocks(0.3 + turn, 2);
      const double early = std::copysign(share * options.axis_tolerance_rad, turn);
      records =
          SampleRun(model, turning_blocks(0.3 + turn - early, 2 - share * options.tip_tolerance_mm))
              .records;
      const CheckReport report = run();
      EXPECT_TRUE(report.passed()) << to_text(report);
      EXPECT_LT(report.axis_rad.value, std::max(0.6, share) * options.axis_tolerance_rad);
    }
  }
}

TEST_F(Check, RefusesATurnOfTheAxisThatIsLeftOut) {
  lift_joint_limits();
  options.tip_tolerance_mm = 0.01;
  options.axis_tolerance_rad = units::rad_from_deg(0.1);
  for (const double turn_deg : {0.11, 0.2, 0.4, 3.0}) {
    SCOPED_TRACE(turn_deg);
    blocks = turning_blocks(0.3 + units::rad_from_deg(turn_deg), 2);
    records = SampleRun(model, {blocks[0], blocks[1], blocks[6], blocks[7], blocks[8]}).records;
    const CheckReport report = run();
    EXPECT_TRUE(has(report, Finding::Kind::kVertex)) << to_text(report);
    records =
        SampleRun(model, turning_blocks(0.3 + units::rad_from_deg(turn_deg - 0.10253), 2)).records;
    const CheckReport early = run();
    expect_only(early, Finding::Kind::kVertex);
    EXPECT_NE(early.findings[0].text.find("by 1.025 tolerances"), std::string::npos)
        << early.findings[0].text;
  }
}

TEST_F(Check, RefusesAFeedAboveTheProgrammedOne) {
  blocks[6].feed = 26;  // the recording was made for 30: 27 at its peak
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kFeed);
  EXPECT_NEAR(report.feed.value, 27.0 / 26.0, 0.01);
  EXPECT_EQ(report.findings[0].line, 7U);
  options.feed_factor = 1.1;
  EXPECT_TRUE(run().passed()) << "an override allows it";
  model.max_feed_mm_per_s = 26.5;
  EXPECT_TRUE(has(run(), Finding::Kind::kFeed)) << "no override lifts the machine's highest feed";
  model.max_feed_mm_per_s = 0;
  const std::uint64_t late = report.findings[0].cycle;
  options.overrides = {{1, 0.9}, {late - 50, 1.1}};
  EXPECT_TRUE(run().passed()) << "in force there";
  options.overrides = {{1, 1.1}, {late - 50, 0.5}};
  EXPECT_TRUE(run().passed()) << "the machine takes a while to follow";
  options.overrides = {{late + 1, 1.1}};
  expect_only(run(), Finding::Kind::kFeed);
}

TEST_F(Check, RefusesMoreMissingCyclesThanAllowed) {
  const std::size_t at = middle_of(5);
  records.erase(records.begin() + static_cast<std::ptrdiff_t>(at),
                records.begin() + static_cast<std::ptrdiff_t>(at) + 3);
  CheckReport report = run();
  expect_only(report, Finding::Kind::kMissingCycles);
  EXPECT_EQ(report.missing, 3U);
  EXPECT_EQ(report.longest_gap, 3U);
  options.max_missing = 3;
  report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
}

TEST_F(Check, RefusesRowsOutOfOrderAndOffTheGrid) {
  records[middle_of(5)].setpoint.due_ns += 300;
  EXPECT_TRUE(has(run(), Finding::Kind::kDueGrid));
  records[middle_of(5)].setpoint.due_ns -= 300;
  std::swap(records[5], records[6]);
  EXPECT_TRUE(has(run(), Finding::Kind::kCycleOrder));
}

TEST_F(Check, RefusesAJointOutsideItsTravel) {
  model.joints[4].limits.travel_max = 0.34;
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kTravel);
  EXPECT_NE(report.findings[0].text.find("theta2"), std::string::npos);
}

TEST_F(Check, RefusesASentVelocityThatIsNotThatOfThePositions) {
  records[middle_of(2)].setpoint.velocity[0] *= 1.01;
  expect_only(run(), Finding::Kind::kSentVelocity);
}

TEST_F(Check, RefusesAnEmptyRecording) {
  records.clear();
  EXPECT_TRUE(has(run(), Finding::Kind::kEmpty));
}

/// The verdict on the sample path whose first `with_first` blocks are cut with one tool, the last
/// ones with a longer one.
class CheckToolChange : public Check {
 protected:
  CheckReport run_with_change_after(int with_first) {
    MachineModel other = model;
    std::vector<ClBlock> first(blocks.begin(), blocks.begin() + with_first);
    std::vector<ClBlock> second(blocks.begin() + 4, blocks.end());
    records = SampleRun(model, first).records;
    // The same joints with a longer tool: the tip sits deeper along the axis.
    other.tool_length_mm = model.tool_length_mm + 15;
    const ToolPose at = forward(other, other.tool_length_mm, records.back().joints);
    second.insert(second.begin(), second.front());
    second[0].tip_mm = to_array(at.tip);
    second[0].axis = to_array(at.axis);
    for (CycleRecord record : SampleRun(other, second).records) {
      record.setpoint.cycle = records.back().setpoint.cycle + 1;
      record.setpoint.due_ns = records.back().setpoint.due_ns + model.cycle_ns;
      records.push_back(record);
    }
    CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
    for (const ClBlock& block : first) path.add(block, 0);
    ClBlock tool;
    tool.kind = BlockKind::kTool;
    path.add(tool, other.tool_length_mm);
    for (std::size_t i = 1; i < second.size(); ++i) path.add(second[i], 0);
    const Scratch file(".csv");
    RecordingReader reader = test::write_and_open(file.path(), model, records);
    const auto report = check(reader, path, model, options);
    EXPECT_TRUE(report.has_value());
    return *report;
  }
};

TEST_F(CheckToolChange, IsFollowedInMidPath) {
  const CheckReport report = run_with_change_after(2);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.vertices, 5U);
}

TEST_F(CheckToolChange, IsFollowedWhereThePathBeginsWithItAsFromItsLineOn) {
  const CheckReport report = run_with_change_after(1);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.vertices, 4U);
}

TEST_F(Check, WritesJsonThatNamesEveryFinding) {
  blocks[6].feed = 26;
  records[middle_of(2)].joints[0] += 0.0005;
  const std::string json = to_json(run());
  EXPECT_NE(json.find("\"passed\": false"), std::string::npos);
  EXPECT_NE(json.find("\"kind\": \"feed\""), std::string::npos);
  EXPECT_NE(json.find("\"kind\": \"jerk\""), std::string::npos);
  EXPECT_EQ(std::count(json.begin(), json.end(), '{'), std::count(json.begin(), json.end(), '}'));
}

}  // namespace
}  // namespace meridian::record
