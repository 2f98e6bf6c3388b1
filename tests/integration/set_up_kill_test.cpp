// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <random>
#include <string>
#include <thread>

#include "integration/set_up_plant.hpp"
#include "service/telemetry/set_up_file.hpp"
#include "support/draws.hpp"

/// A service that is killed while it changes its set-up. MERIDIAN_SETUP_KILLS=100 in the
/// environment for more of it, MERIDIAN_SETUP_SEED for others.
namespace meridian::test {
namespace {

[[nodiscard]] WorkFrames on_disk(const Plant& plant) {
  const auto frames = telemetry::SetUpFile(plant.state(), "lai").read();
  EXPECT_TRUE(frames) << frames.error();
  return frames ? *frames : WorkFrames();
}

TEST(SetUpKill, LeavesTheOldSetUpOrTheNewOneAtAnyInstant) {
  const int kills = number_of("MERIDIAN_SETUP_KILLS", 8);
  const auto seed = number_of<std::uint32_t>("MERIDIAN_SETUP_SEED", 20261125);
  std::printf("seed %u\n", seed);
  std::mt19937 engine(seed);
  Plant plant;
  WorkFrames acknowledged;
  int kept = 0, changed = 0;
  for (int n = 1; n <= kills; ++n) {
    SCOPED_TRACE(testing::Message() << "kill " << n);
    plant.start_service();
    ASSERT_TRUE(plant.runs_until([](const dds::Status& status) { return status.cycles_run > 0; }))
        << plant.service().said();
    const dds::MachineInfo told = told_by(plant);
    EXPECT_TRUE(std::equal(told.work_frames.begin(), told.work_frames.end(),
                           acknowledged.rows().begin(), acknowledged.rows().end()));
    EXPECT_EQ(told.work_frame, acknowledged.active());
    // A word for the table and one for the row in force, in turns.
    const int number = 1 + n / 2 % 3;
    const bool is_select = n % 2 == 1 && acknowledged.find(number) != nullptr;
    const FrameOrder order = order_of(is_select ? FrameWord::kSelect : FrameWord::kSet, number, n);
    WorkFrames asked = acknowledged;
    ASSERT_EQ(asked.apply(order), FrameFault::kNone);
    SetUpOperator anna(plant, 100 + static_cast<std::uint64_t>(n));
    anna.say(order, plant.status());
    const int wait_us = std::uniform_int_distribution<int>(0, 150'000)(engine);
    std::this_thread::sleep_for(std::chrono::microseconds(wait_us));
    plant.service().send_signal(SIGKILL);
    ASSERT_TRUE(plant.service().wait(milliseconds(2000)));
    const WorkFrames left = on_disk(plant);
    EXPECT_TRUE(left == acknowledged || left == asked) << "a mixture";
    const auto reply = anna.answer(milliseconds(100));
    if (reply && reply->is_accepted) {
      EXPECT_EQ(left, asked) << "it was acknowledged";
    }
    ++(left == asked ? changed : kept);
    acknowledged = left;
  }
  std::printf("%d kills: %d left the old set-up, %d the new one\n", kills, kept, changed);
}

}  // namespace
}  // namespace meridian::test
