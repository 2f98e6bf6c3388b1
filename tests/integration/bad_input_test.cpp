// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "integration/plant.hpp"
#include "integration/raw_station.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::test {
namespace {

using dds::Verdict;

constexpr double kFeed_mm_per_min = 6000;

/// What the service's recording says about the motion of a run.
struct Motion {
  std::uint64_t rows_moving = 0;
  std::uint64_t last_sequence_moving = 0;  ///< highest CL block that moved anything
  bool is_in_order = true;                 ///< blocks never went back
  ToolPose rest_pose{};                    ///< where the machine came to rest
};

/// Service and drives, enabled, and a station that behaves badly.
class BadInput : public testing::Test {
 protected:
  void SetUp() override {
    plant.start_service();
    plant.start_drives();
    ASSERT_TRUE(plant.enable()) << plant.service().said();
    const auto answer = station.open(policies());
    ASSERT_TRUE(answer) << plant.service().said();
    ASSERT_EQ(answer->verdict, Verdict::kGood) << answer->text;
  }

  /// What its session asks for.
  [[nodiscard]] virtual std::uint32_t policies() const { return 0; }

  /// Starts the machine and waits until it has run out of blocks.
  void run_out() {
    ASSERT_TRUE(plant.wait_for(State::kLoaded)) << plant.service().said();
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
    ASSERT_TRUE(plant.wait_for(State::kStarved, milliseconds(20000))) << plant.service().said();
  }

  /// Ends the service and reads its recording.
  Motion motion_of_run() {
    plant.service().send_signal(SIGTERM);
    EXPECT_EQ(plant.service().wait(milliseconds(8000)), 0) << plant.service().said();
    Motion motion;
    auto reader = record::RecordingReader::open(plant.recording().string(), model);
    if (!reader) {
      ADD_FAILURE() << reader.error().text();
      return motion;
    }
    record::RecordingRow row;
    while (true) {
      const auto has_row = reader->next(row);
      if (!has_row) ADD_FAILURE() << has_row.error().text();
      if (!has_row || !*has_row) break;
      if ((row.flags & kSetpointEnabled) == 0) continue;
      motion.rest_pose = forward(model, model.tool_length_mm, row.joints);
      if ((row.flags & kSetpointMoving) == 0) continue;
      ++motion.rows_moving;
      motion.is_in_order = motion.is_in_order && row.sequence >= motion.last_sequence_moving;
      motion.last_sequence_moving = std::max(motion.last_sequence_moving, row.sequence);
    }
    return motion;
  }

  /// Three good blocks run, the fourth is spoilt by `spoil` and refused with `text`; nothing of it
  /// or after it moves anything.
  void refuses(const std::function<void(ClBlock&)>& spoil, const std::string& text) {
    std::vector<ClBlock> blocks = small_program(6, kFeed_mm_per_min);
    spoil(blocks[3]);
    station.send(0, blocks);
    const auto answer = station.wait_for(Verdict::kRefusedBlock);
    ASSERT_TRUE(answer) << plant.service().said();
    EXPECT_EQ(answer->verdict_sequence, 3u);
    EXPECT_EQ(answer->verdict_line, blocks[3].line);
    EXPECT_EQ(answer->credits, 0u);
    EXPECT_NE(answer->text.find("line 4, block 3: "), std::string::npos) << answer->text;
    EXPECT_NE(answer->text.find(text), std::string::npos) << answer->text;
    const std::vector<ClBlock> good = small_program(6, kFeed_mm_per_min);
    station.send(3, {good.begin() + 3, good.end()});  // it does not take no for an answer
    ASSERT_NO_FATAL_FAILURE(run_out());
    EXPECT_NE(plant.service().said().find(answer->text), std::string::npos) << "not in the log";
    const Motion motion = motion_of_run();
    EXPECT_GT(motion.rows_moving, 0u);
    EXPECT_EQ(motion.last_sequence_moving, 2u);
    expect_at(motion.rest_pose, blocks[2]);
  }

  static void expect_at(const ToolPose& pose, const ClBlock& block) {
    EXPECT_LT((pose.tip - to_vector(block.tip_mm)).norm(), 1e-6) << "mm from the last good block";
    EXPECT_LT((pose.axis - to_vector(block.axis)).norm(), 1e-9);
  }

  const MachineModel model = config::load_machine(machine_file());
  Plant plant;
  RawStation station{plant.participant()};
};

TEST_F(BadInput, ANumberThatIsNoNumberMovesNothing) {
  refuses([](ClBlock& block) { block.tip_mm[1] = std::numeric_limits<double>::quiet_NaN(); },
          "tip y is not a finite number");
}

/// Cuts run on through blocks: what is in front of a bad one comes to its end all the same.
class SmoothBadInput : public BadInput {
 protected:
  [[nodiscard]] std::uint32_t policies() const override { return dds::kPolicySmooth; }
};

TEST_F(SmoothBadInput, AnAxisOfLengthZeroMovesNothing) {
  refuses(
      [](ClBlock& block) {
        block.axis = {0, 0, 0};
      },
      "tool axis or arc normal has length 0, not 1");
}

TEST_F(BadInput, AnUnreachableBlockMovesNothing) {
  refuses(
      [](ClBlock& block) {
        const double tilt = units::rad_from_deg(75);
        block.axis = {std::sin(tilt), 0, std::cos(tilt)};
      },
      "theta2 at 75 deg (travel -60 to 60 deg)");
}

TEST_F(BadInput, AGreatCircleThatLeavesTravelBetweenTwoLegalBlocksMovesNothing) {
  // Tip 680 mm off the axis of C; the tool axis goes round from azimuth 0 to 80 degrees. Both ends
  // have b2 at 581 mm; half way it would need 740 mm (and -620 mm on the other branch).
  constexpr double kRadius_mm = 680;
  const double tilt = units::rad_from_deg(30), corner = units::rad_from_deg(130);
  ClBlock block = small_program(1, kFeed_mm_per_min)[0];
  block.tip_mm = {kRadius_mm * std::cos(corner), kRadius_mm * std::sin(corner), 190};
  std::vector<ClBlock> blocks(4, block);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const double azimuth = units::rad_from_deg(i == 2 ? 80 : 0);
    blocks[i].sequence = i;
    blocks[i].line = 40 + i;
    blocks[i].tip_mm[2] += i;
    blocks[i].axis = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                      std::cos(tilt)};
  }
  station.send(0, blocks, true);
  ASSERT_TRUE(station.wait_for(Verdict::kComplete)) << "each block alone is legal";
  const auto answer = station.wait_for(Verdict::kRefusedBlock);
  ASSERT_TRUE(answer) << plant.service().said();
  EXPECT_EQ(answer->verdict_sequence, 2u);
  EXPECT_EQ(answer->verdict_line, 42u);
  EXPECT_EQ(answer->verdict_joint, 1);
  EXPECT_NE(answer->text.find("line 42, block 2: b2 at "), std::string::npos) << answer->text;
  EXPECT_NE(answer->text.find("on the way from the block before"), std::string::npos)
      << answer->text;
  EXPECT_FALSE(plant.wait_for(State::kLoaded, milliseconds(500))) << "there is nothing to start";
  EXPECT_EQ(motion_of_run().rows_moving, 0u);
}

TEST_F(BadInput, ACorruptedBatchIsAskedForAgainAndMovesNothing) {
  const std::vector<ClBlock> blocks = small_program(3, kFeed_mm_per_min);
  dds::Batch batch = station.batch(0, blocks, true);
  batch.blocks[1].tip_mm[0] += 100;  // after the CRC was made
  station.send(batch);
  const auto answer = station.wait_for(Verdict::kGap);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->next_sequence, 0u);
  EXPECT_EQ(answer->text, "a batch was corrupted: send again from block 0");
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start);
  EXPECT_FALSE(start->is_accepted);
  EXPECT_EQ(start->refusal, Refusal::kNoProgram);
  EXPECT_TRUE(eventually([&] { return plant.status().batches_lost == 1; }));
  EXPECT_EQ(motion_of_run().rows_moving, 0u);
}

TEST_F(BadInput, AGapIsAskedForAgainFromTheLastGoodBlock) {
  const std::vector<ClBlock> blocks = small_program(9, kFeed_mm_per_min);
  station.send(0, {blocks.begin(), blocks.begin() + 3});
  station.send(6, {blocks.begin() + 6, blocks.end()}, true);
  const auto answer = station.wait_for(Verdict::kGap);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->next_sequence, 3u);
  EXPECT_EQ(answer->text, "blocks 3 to 5 are missing: send again");
  ASSERT_NO_FATAL_FAILURE(run_out());
  const Motion motion = motion_of_run();
  EXPECT_EQ(motion.last_sequence_moving, 2u) << "something after the gap was run";
  expect_at(motion.rest_pose, blocks[2]);
}

TEST_F(BadInput, ADuplicateRunsOnce) {
  const std::vector<ClBlock> blocks = small_program(4, kFeed_mm_per_min);
  for (int i = 0; i < 3; ++i) station.send(0, blocks);
  ASSERT_TRUE(
      station.wait_for([](const dds::Credit& credit) { return credit.next_sequence == 4; }));
  EXPECT_TRUE(eventually([&] { return plant.status().batches_dropped == 2; }));
  EXPECT_EQ(plant.status().blocks_received, 4u);
  ASSERT_NO_FATAL_FAILURE(run_out());
  const dds::Status status = plant.status();
  EXPECT_EQ(status.blocks_done, 4u);
  const Motion motion = motion_of_run();
  EXPECT_TRUE(motion.is_in_order) << "a block was run again";
  EXPECT_EQ(motion.last_sequence_moving, 3u);
  expect_at(motion.rest_pose, blocks[3]);
}

TEST_F(BadInput, BlocksBeyondCreditAreDroppedAndTheSessionRefused) {
  const std::vector<ClBlock> blocks = small_program(3, kFeed_mm_per_min);
  station.send(0, blocks);
  const auto granted =
      station.wait_for([](const dds::Credit& credit) { return credit.next_sequence == 3; });
  ASSERT_TRUE(granted);
  EXPECT_GE(granted->credits, 5000u - 3u);
  station.send(granted->next_sequence + granted->credits - 1, blocks);
  const auto answer = station.wait_for(Verdict::kBeyondCredit);
  ASSERT_TRUE(answer);
  EXPECT_NE(answer->text.find("had credit up to "), std::string::npos) << answer->text;
  EXPECT_EQ(answer->credits, 0u);
  const std::vector<ClBlock> more = small_program(6, kFeed_mm_per_min);
  station.send(3, {more.begin() + 3, more.end()});
  ASSERT_NO_FATAL_FAILURE(run_out());
  const Motion motion = motion_of_run();
  EXPECT_EQ(motion.last_sequence_moving, 2u);
  expect_at(motion.rest_pose, blocks[2]);
}

TEST_F(BadInput, ABatchOfAnOldSessionMovesNothing) {
  const std::vector<ClBlock> blocks = small_program(6, kFeed_mm_per_min);
  station.send(0, {blocks.begin(), blocks.begin() + 3});
  ASSERT_TRUE(plant.wait_for(State::kLoaded));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_TRUE(station.wait_for(Verdict::kAborted));
  ASSERT_TRUE(plant.wait_for(State::kReady));
  station.send(3, {blocks.begin() + 3, blocks.end()}, true);
  const auto answer = station.wait_for(Verdict::kAborted);
  ASSERT_TRUE(answer) << "an old session is answered how it ended";
  EXPECT_TRUE(eventually([&] { return plant.status().batches_dropped == 1; }));
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->refusal, Refusal::kNoProgram) << start->text;
  EXPECT_EQ(motion_of_run().rows_moving, 0u);
}

TEST_F(BadInput, ASecondStationIsRefusedByName) {
  station.send(0, small_program(3, kFeed_mm_per_min));
  RawStation second(plant.participant(), "second");
  const auto answer = second.open();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kRefusedStation);
  EXPECT_NE(answer->text.find("held by station raw with program raw.apt"), std::string::npos)
      << answer->text;
  EXPECT_EQ(answer->credits, 0u);
  std::vector<ClBlock> blocks = small_program(6, kFeed_mm_per_min);
  second.send(3, {blocks.begin() + 3, blocks.end()}, true);  // it sends all the same
  ASSERT_TRUE(second.wait_for(Verdict::kClosed)) << "dropped, and answered so";
  ASSERT_NO_FATAL_FAILURE(run_out());
  EXPECT_EQ(motion_of_run().last_sequence_moving, 2u);
}

}  // namespace
}  // namespace meridian::test
