// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "scratch.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/check/compare.hpp"
#include "support/machines.hpp"
#include "support/sample_recording.hpp"

/// Recordings of a machine with an actuator stage: both joints and drives are written and checked.
namespace meridian::record {
namespace {

using test::cut_to;
using test::Scratch;

constexpr std::size_t kFirst = 1, kSecond = 3;  // where the sliders stand in drive order

class StageRecording : public ::testing::Test {
 protected:
  StageRecording()
      : blocks{cut_to(1, {80, -40, 20}, 0.3, 30), cut_to(2, {82, -40, 20}, 0.3, 30),
               cut_to(3, {82, -37, 19}, 0.35, 30)},
        records(test::SampleRun(model, blocks).records) {}

  [[nodiscard]] CheckReport run() const {
    const Scratch file(".csv");
    RecordingReader reader = test::write_and_open(file.path(), model, records);
    CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
    for (const ClBlock& block : blocks) path.add(block, model.tool_length_mm);
    auto report = check(reader, path, model, {});
    EXPECT_TRUE(report.has_value());
    return *report;
  }

  void expect_only(Finding::Kind kind, const std::string& word) const {
    const CheckReport report = run();
    ASSERT_EQ(report.findings.size(), 1U) << to_text(report);
    EXPECT_EQ(report.findings[0].kind, kind) << to_text(report);
    EXPECT_NE(report.findings[0].text.find(word), std::string::npos) << report.findings[0].text;
  }

  MachineModel model = test::hybrid_machine();
  std::vector<ClBlock> blocks;
  std::vector<CycleRecord> records;
};

TEST_F(StageRecording, HasTheDrivesBehindTheJoints) {
  const Scratch file(".csv");
  RecordingReader reader = test::write_and_open(file.path(), model, records);
  const std::string text = test::read_text(file.path());
  EXPECT_EQ(text.find("cycle,due_ns,line,kind,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad,u1_mm,u2_mm,"
                      "b3_mm_per_s,b2_mm_per_s,b4_mm_per_s,theta1_rad_per_s,theta2_rad_per_s,"
                      "u1_mm_per_s,u2_mm_per_s,sequence,"),
            0U)
      << text.substr(0, 300);
  EXPECT_TRUE(reader.has_velocity());
  RecordingRow row;
  for (const CycleRecord& record : records) {
    ASSERT_TRUE(reader.next(row).value_or(false));
    ASSERT_EQ(row.joints, record.joints);
    ASSERT_EQ(row.positions, limited_of(model, record.joints, record.setpoint.position));
    ASSERT_EQ(drives_at(model, row.positions), record.setpoint.position);
    ASSERT_EQ(row.velocity[5], record.setpoint.velocity[kFirst]);
    ASSERT_EQ(row.velocity[6], record.setpoint.velocity[kSecond]);
  }
}

TEST_F(StageRecording, GivesJointsWhereOnlyTheDrivesWereSeen) {
  const Scratch file(".csv");
  const JointVector q{10, 20, 30, 0.4, 0.5};
  const JointVector u = drives_of(model, q);
  char text[512];
  std::snprintf(
      text, sizeof text,
      "cycle,due_ns,b3_mm,u1_mm,b4_mm,u2_mm,theta2_rad\n1,0,%.17g,%.17g,%.17g,%.17g,%.17g\n", u[0],
      u[1], u[2], u[3], u[4]);
  test::write_text(file.path(), text);
  auto reader = RecordingReader::open(file.path(), model);
  ASSERT_TRUE(reader.has_value()) << reader.error().text();
  RecordingRow row;
  ASSERT_TRUE(reader->next(row).value_or(false));
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(row.joints[i], q[i], 1e-12);
  EXPECT_EQ(drives_at(model, row.positions), u);
}

TEST_F(StageRecording, GivesDrivesWhereOnlyTheJointsWereWritten) {
  const Scratch file(".csv");
  test::write_text(file.path(),
                   "cycle,due_ns,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad\n1,0,10,20,30,0.4,0.5\n");
  auto reader = RecordingReader::open(file.path(), model);
  ASSERT_TRUE(reader.has_value()) << reader.error().text();
  RecordingRow row;
  ASSERT_TRUE(reader->next(row).value_or(false));
  EXPECT_EQ(row.positions, limited_of(model, JointVector{10, 20, 30, 0.4, 0.5}));
}

TEST_F(StageRecording, NeedsTheJointsOrTheDrives) {
  const Scratch file(".csv");
  test::write_text(file.path(), "cycle,due_ns,b3_mm,u1_mm,b4_mm,theta2_rad\n1,0,1,2,3,4\n");
  const auto reader = RecordingReader::open(file.path(), model);
  ASSERT_FALSE(reader.has_value());
  EXPECT_NE(reader.error().text().find("b2_mm"), std::string::npos) << reader.error().text();
}

TEST_F(StageRecording, ATrueOnePassesAndReportsTheDistanceFromADeadPoint) {
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  ASSERT_EQ(report.joint_count, 7);
  EXPECT_EQ(report.joint_names[5], "u1");
  EXPECT_GT(report.joints[6].velocity.value, 0.001);
  EXPECT_LT(report.stage.apart_mm.value, 1e-12);
  double min = 1e9;
  for (const CycleRecord& record : records) {
    min = std::min(min, 2 * model.stage.radius_mm * std::cos(record.joints[3]));
  }
  EXPECT_NEAR(report.stage.determinant_mm, min, 1e-9);
  EXPECT_NE(to_text(report).find("least determinant"), std::string::npos);
  EXPECT_NE(to_json(report).find("\"stage_determinant_mm_per_rad\""), std::string::npos);
}

TEST_F(StageRecording, ADriveThatIsNotWhereTheJointsPutItIsFound) {
  for (CycleRecord& record : records) record.setpoint.position[kSecond] += 1e-7;
  expect_only(Finding::Kind::kStage, "1e-07");
}

TEST_F(StageRecording, DrivesThatNobodyHasHeardOfYetAreNotHeldAgainstTheJoints) {
  for (std::size_t i = 0; i < 5; ++i) {
    records[i].setpoint.flags = 0;
    records[i].setpoint.position = JointVector{};
  }
  EXPECT_TRUE(run().passed()) << to_text(run());
  records[2].setpoint.flags = kSetpointEnabled;
  EXPECT_FALSE(run().passed());
}

TEST_F(StageRecording, ADriveBeyondItsLimitsIsFoundByName) {
  model.stage_drives[1].limits.velocity = 5;
  expect_only(Finding::Kind::kVelocity, "u2");
}

TEST_F(StageRecording, ADriveOutsideItsTravelIsFoundByName) {
  model.stage_drives[0].limits.travel_max = records[0].setpoint.position[kFirst] - 20;
  expect_only(Finding::Kind::kTravel, "u1");
}

TEST_F(StageRecording, TwoThatDifferInABitOfADriveAreNotTheSame) {
  const Scratch a(".csv"), b(".csv");
  RecordingReader reader_a = test::write_and_open(a.path(), model, records);
  double& changed = records[records.size() / 2].setpoint.position[kSecond];
  changed = std::nextafter(changed, 1e9);
  RecordingReader reader_b = test::write_and_open(b.path(), model, records);
  const auto report = compare(reader_a, reader_b, model);
  ASSERT_TRUE(report.has_value());
  EXPECT_FALSE(report->is_same());
  EXPECT_EQ(report->different, 1U);
  EXPECT_EQ(report->first_joint, 6);
  EXPECT_NE(to_text(*report, "a", "b", model).find("u2_mm"), std::string::npos);
}

}  // namespace
}  // namespace meridian::record
