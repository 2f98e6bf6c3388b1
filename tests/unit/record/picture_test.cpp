// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/picture/picture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "scratch.hpp"
#include "service/recording/record/picture/picture_data.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "support/sample_recording.hpp"

namespace meridian::record {
namespace {

using test::cut_to;
using test::SampleRun;
using test::Scratch;

class Picture : public ::testing::Test {
 protected:
  Picture() {
    for (const ClBlock& block : blocks) path.add(block, 0);
  }
  MachineModel model = test::lai_machine();
  std::vector<ClBlock> blocks{cut_to(1, {80, -40, 20}, 0.3, 30), cut_to(2, {82, -40, 20}, 0.3, 30),
                              cut_to(3, {82, -37, 19}, 0.35, 30)};
  std::vector<CycleRecord> records = SampleRun(model, blocks).records;
  CheckedPath path{model.tool_length_mm, 0};
};

TEST_F(Picture, LosesNoPeakInItsColumns) {
  records[150].joints[0] += 0.0005;
  const Scratch file(".csv");
  RecordingReader reader = test::write_and_open(file.path(), model, records);
  PictureData data;
  ASSERT_FALSE(gather(reader, path, model, 20, data));
  ASSERT_EQ(data.columns.size(), 20U);
  double peak = 0;
  for (const PictureColumn& column : data.columns) peak = std::max(peak, column.rate[2][0].high);
  EXPECT_NEAR(peak, 3 * 0.0005 / 1e-9 / model.joints[0].limits.jerk, 0.3);
  EXPECT_EQ(data.columns[10].feed_mm_per_s.high, 30);
  EXPECT_GT(data.tip.size(), 50U);
}

TEST_F(Picture, IsAFileOfTheKindItsNameSays) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gnuplot is not installed";
  const Scratch csv(".csv"), svg(".svg"), png(".png");
  RecordingReader reader = test::write_and_open(csv.path(), model, records);
  const auto error = draw(reader, path, model, "part", svg.path());
  ASSERT_FALSE(error) << error->text();
  EXPECT_NE(test::read_text(svg.path()).find("<svg"), std::string::npos);
  ASSERT_FALSE(draw(reader, path, model, "part", png.path()));
  EXPECT_EQ(test::read_text(png.path()).substr(1, 3), "PNG");
}

TEST_F(Picture, SaysThatTheFeedIsUnknownWhereTheFileHasNone) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gnuplot is not installed";
  const Scratch csv(".csv"), svg(".svg");
  RecordingReader reader = test::write_and_open(csv.path(), model, records);
  const CheckedPath without{model.tool_length_mm, 0};
  const auto error = draw(reader, without, model, "part", svg.path());
  ASSERT_FALSE(error) << error->text();
  EXPECT_NE(test::read_text(svg.path()).find("feed unknown"), std::string::npos);
  ASSERT_FALSE(draw(reader, path, model, "part", svg.path()));
  EXPECT_EQ(test::read_text(svg.path()).find("feed unknown"), std::string::npos);
  EXPECT_NE(test::read_text(svg.path()).find("programmed"), std::string::npos);
}

TEST(PictureOfARobot, HasNoPanelOfLinearJoints) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gnuplot is not installed";
  MachineModel model = test::robot_machine(true);
  for (int i = 0; i < model.joint_count; ++i) model.joints[i].name = "j" + std::to_string(i + 1);
  JointVector joints{0.1, 0.2, -0.3, 0.1, 0.7, 0.2};
  std::vector<CycleRecord> records(200);
  for (std::size_t i = 0; i < records.size(); ++i) {
    joints[0] += 1e-5 * static_cast<double>(i);
    records[i].joints = records[i].setpoint.position = joints;
    records[i].setpoint.cycle = i + 1;
    records[i].setpoint.flags = kSetpointEnabled;
  }
  const Scratch csv(".csv"), svg(".svg");
  RecordingReader reader = test::write_and_open(csv.path(), model, records);
  const auto error = draw(reader, CheckedPath{0, 0}, model, "part", svg.path());
  ASSERT_FALSE(error) << error->text();
  const std::string text = test::read_text(svg.path());
  EXPECT_NE(text.find("joints, deg"), std::string::npos);
  EXPECT_EQ(text.find("joints, mm"), std::string::npos);
}

TEST_F(Picture, ShowsTheToolAxisAlongTheCut) {
  const Scratch file(".csv");
  RecordingReader reader = test::write_and_open(file.path(), model, records);
  PictureData data;
  ASSERT_FALSE(gather(reader, path, model, 20, data));
  const Vector3 wanted = to_vector(blocks.back().axis);
  EXPECT_LT((data.tip.back().axis - wanted).norm(), 1e-5);
}

TEST_F(Picture, RefusesOtherFormatsAndRecordingsAtRest) {
  const Scratch csv(".csv"), svg(".svg");
  RecordingReader reader = test::write_and_open(csv.path(), model, records);
  ASSERT_TRUE(draw(reader, path, model, "part", "picture.jpeg"));
  records.resize(10);
  RecordingReader still = test::write_and_open(csv.path(), model, records);
  const auto error = draw(still, path, model, "part", svg.path());
  ASSERT_TRUE(error);
  EXPECT_NE(error->text().find("nothing moves"), std::string::npos);
}

}  // namespace
}  // namespace meridian::record
