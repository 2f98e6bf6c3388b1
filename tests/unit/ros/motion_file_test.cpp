// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/motion_file.hpp"

#include <gtest/gtest.h>

#include <map>

#include "support/machines.hpp"
#include "support/mcap_reading.hpp"
#include "support/text_file.hpp"

namespace meridian::ros {
namespace {

using test::CdrParts;
using test::TextFile;

[[nodiscard]] record::RecordingRow row_at(const MachineModel& model, std::uint64_t cycle) {
  record::RecordingRow row;
  row.cycle = cycle;
  row.due_ns = static_cast<std::int64_t>(cycle) * model.cycle_ns;
  row.line = 40;
  row.sequence = 4;
  row.joints = {10, 20 + 0.01 * static_cast<double>(cycle), 30, 0.4, 0.5};
  row.positions = limited_of(model, row.joints);
  row.velocity[1] = 10;
  row.feedback = row.joints;
  row.feedback_cycle = cycle;
  row.plan_time_s = 0.25;
  row.rate = 0.5;
  row.lateness_ns = 2000;
  row.computation_ns = 3000;
  row.epoch = 6;
  row.state = State::kHolding;
  row.kind = MotionKind::kRapid;
  return row;
}

[[nodiscard]] test::McapContent write(const MachineModel& model, const Contents& contents,
                                      std::uint64_t rows) {
  const TextFile out("", ".mcap");
  auto file = MotionFile::create(out.path(), model, contents, "run.csv");
  EXPECT_TRUE(file.has_value());
  for (std::uint64_t cycle = 0; cycle < rows; ++cycle) {
    EXPECT_TRUE((*file)->write(row_at(model, cycle)));
  }
  EXPECT_FALSE((*file)->close());
  return test::read_mcap(test::read_text(out.path()));
}

[[nodiscard]] std::map<std::string, std::size_t> counts_of(const test::McapContent& content) {
  std::map<std::string, std::size_t> out;
  for (const auto& message : content.messages) ++out[message.topic];
  return out;
}

/// The one message of the topic with that number.
[[nodiscard]] CdrParts find(const test::McapContent& content, const std::string& topic,
                            std::uint32_t sequence) {
  for (const auto& message : content.messages) {
    if (message.topic == topic && message.sequence == sequence) return CdrParts(message.data);
  }
  ADD_FAILURE() << topic << " has no message " << sequence;
  return CdrParts("nothing");
}

/// Reads past std_msgs/Header.
void skip_header(CdrParts& parts) {
  (void)parts.number<std::int32_t>();
  (void)parts.number<std::uint32_t>();
  (void)parts.text();
}

TEST(MotionFile, HasAMessageOfEveryRowAndForTheScreenOfEveryFortieth) {
  const auto content = write(test::lai_machine(), {}, 1001);
  EXPECT_TRUE(content.has_end && content.is_sound);
  EXPECT_EQ(counts_of(content), (std::map<std::string, std::size_t>{{"/cycle", 1001},
                                                                    {"/joint_states", 26},
                                                                    {"/tip", 26},
                                                                    {"/limit_shares", 26},
                                                                    {"/tf", 26},
                                                                    {"/machine", 1},
                                                                    {"/trail", 2},
                                                                    {"/events", 1}}));
  EXPECT_EQ(content.metadata.at("machine"), test::lai_machine().name);
  EXPECT_EQ(content.metadata.at("recording"), "run.csv");
}

TEST(MotionFile, WritesTheSharesThatAreLeftAtTheEnd) {
  EXPECT_EQ(counts_of(write(test::lai_machine(), {}, 1))["/limit_shares"], 1U);
  EXPECT_EQ(counts_of(write(test::lai_machine(), {}, 6))["/limit_shares"], 2U);
}

constexpr std::array<double, 5> kWanted{0.010, 0.0204, 0.030, 0.4, 0.5};  // m and rad, row 40

TEST(MotionFile, SaysJointStatesInMetresAndRadians) {
  const MachineModel model = test::lai_machine();
  const auto content = write(model, {}, 41);
  CdrParts parts = find(content, "/joint_states", 1);
  EXPECT_EQ(parts.number<std::int32_t>(), 0);
  EXPECT_EQ(parts.number<std::uint32_t>(), 40U * static_cast<std::uint64_t>(model.cycle_ns));
  EXPECT_EQ(parts.text(), "");
  ASSERT_EQ(parts.number<std::uint32_t>(), 5U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(parts.text(), model.joints[i].name);
  ASSERT_EQ(parts.number<std::uint32_t>(), 5U);
  for (const double wanted : kWanted) EXPECT_NEAR(parts.number<double>(), wanted, 4.7e-10);
  ASSERT_EQ(parts.number<std::uint32_t>(), 5U);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(parts.number<double>(), i == 1 ? 0.01 : 0, 5e-7);
  EXPECT_EQ(parts.number<std::uint32_t>(), 0U);
  EXPECT_TRUE(parts.is_over());
}

TEST(MotionFile, SaysEverythingOfARowInOneMessage) {
  const MachineModel model = test::lai_machine();
  const auto content = write(model, {.has_alarm = true, .has_feedback = true}, 41);
  CdrParts parts = find(content, "/cycle", 40);
  skip_header(parts);
  EXPECT_EQ(parts.number<std::uint64_t>(), 40U);
  for (const double wanted : kWanted) EXPECT_NEAR(parts.number<double>(), wanted, 4.7e-10);
  const Pose<double> pose = forward(model, model.tool_length_mm, row_at(model, 40).joints);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(parts.number<double>(), 1e-3 * pose.tip[i], 5e-10);
  for (const double wanted : kWanted) EXPECT_NEAR(parts.number<double>(), wanted, 3.8e-9);
  EXPECT_EQ(parts.number<std::uint64_t>(), 4U) << "block";
  EXPECT_EQ(parts.number<double>(), 0.25) << "plan time";
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(parts.number<float>(), i == 1 ? 0.01 : 0, 5e-7);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(parts.number<float>(), pose.axis[i], 5e-7);
  EXPECT_NEAR(parts.number<float>(), 0.01, 5e-7) << "feed: joint 1 moves 0.01 mm a cycle";
  EXPECT_EQ(parts.number<float>(), 0.0F) << "turn";
  EXPECT_EQ(parts.number<float>(), 0.5F) << "rate";
  EXPECT_EQ(parts.number<float>(), 2e-6F) << "lateness";
  EXPECT_EQ(parts.number<float>(), 3e-6F) << "computation";
  EXPECT_EQ(parts.number<std::uint32_t>(), 40U);
  EXPECT_EQ(parts.number<std::uint16_t>(), 6U) << "epoch";
  EXPECT_EQ(parts.number<std::uint16_t>(), kSetpointEnabled);
  EXPECT_EQ(parts.number<std::uint8_t>(), static_cast<std::uint8_t>(State::kHolding));
  EXPECT_EQ(parts.number<std::uint8_t>(), static_cast<std::uint8_t>(MotionKind::kRapid));
  EXPECT_EQ(parts.number<std::uint8_t>(), static_cast<std::uint8_t>(Alarm::kNone));
  EXPECT_TRUE(parts.is_over());
}

TEST(MotionFile, HasTheDrivesOfAStageBehindTheJoints) {
  const MachineModel model = test::hybrid_machine();
  ASSERT_TRUE(has_stage(model));
  const auto content = write(model, {}, 1);
  CdrParts parts = find(content, "/joint_states", 0);
  skip_header(parts);
  ASSERT_EQ(parts.number<std::uint32_t>(), 7U);
  for (int i = 0; i < 7; ++i) EXPECT_EQ(parts.text(), limited_spec(model, i).name);
}

TEST(MotionFile, HasWhatDrivesSayOfEveryRowOfTheFlightRecorder) {
  const MachineModel model = test::lai_machine();
  const auto content =
      write(model, {.has_alarm = true, .has_feedback = true, .has_statuswords = true}, 20);
  EXPECT_EQ(counts_of(content)["/drives"], 20U);
  CdrParts parts = find(content, "/drives", 13);
  skip_header(parts);
  EXPECT_EQ(parts.number<std::uint64_t>(), 13U);
  EXPECT_EQ(parts.number<double>(), -1.0) << "no report came";
  EXPECT_EQ(parts.number<std::uint8_t>(), 0U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(parts.number<float>(), 0.0F);
    EXPECT_EQ(parts.number<std::uint16_t>(), 0U);
    EXPECT_EQ(parts.number<std::uint16_t>(), 0U);
  }
  EXPECT_TRUE(parts.is_over());
}

TEST(MotionFile, KeepsTheLargestFollowingErrorOfFortyMilliseconds) {
  const MachineModel model = test::lai_machine();
  const TextFile out("", ".mcap");
  auto file = MotionFile::create(out.path(), model, {.has_state = false, .has_feedback = true}, "");
  ASSERT_TRUE(file.has_value());
  for (std::uint64_t cycle = 1; cycle <= 81; ++cycle) {
    record::RecordingRow row = row_at(model, cycle);
    row.feedback[1] -= cycle == 73 ? 0.2 : 0.1;
    EXPECT_TRUE((*file)->write(row));
  }
  EXPECT_FALSE((*file)->close());
  const auto content = test::read_mcap(test::read_text(out.path()));
  EXPECT_EQ(counts_of(content)["/drives"], 3U);
  for (std::uint32_t n = 0; n < 3; ++n) {
    CdrParts parts = find(content, "/drives", n);
    skip_header(parts);
    EXPECT_EQ(parts.number<std::uint64_t>(), n == 0 ? 1U : 40U * n);
    EXPECT_EQ(parts.number<float>(), 0.0F);
    EXPECT_NEAR(parts.number<float>(), n == 2 ? -0.0002 : -0.0001, 4e-9);
  }
}

TEST(MotionFile, RefusesTimesThatRosCannotSay) {
  EXPECT_TRUE(MotionFile::has_time(0));
  EXPECT_TRUE(MotionFile::has_time(2'147'483'647'999'999'999));
  EXPECT_FALSE(MotionFile::has_time(2'147'483'648'000'000'000));
  EXPECT_FALSE(MotionFile::has_time(-1));
}

}  // namespace
}  // namespace meridian::ros
