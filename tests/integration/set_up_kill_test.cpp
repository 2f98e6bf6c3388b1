// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <random>
#include <string>
#include <thread>

#include "integration/set_up_plant.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/telemetry/journal/set_up_file.hpp"
#include "support/draws.hpp"

/// A service that is killed while it changes its set-up. MERIDIAN_SETUP_KILLS=500 in the
/// environment for more of it, MERIDIAN_SETUP_SEED for others.
namespace meridian::test {
namespace {

[[nodiscard]] telemetry::SetUp on_disk(const Plant& plant) {
  const auto set_up = telemetry::SetUpFile(plant.state(), "lai").read();
  EXPECT_TRUE(set_up) << set_up.error();
  return set_up ? *set_up : telemetry::SetUp();
}

/// What the machine publishes is `acknowledged`.
void expect_reported(const dds::MachineInfo& published, const telemetry::SetUp& acknowledged) {
  const WorkFrames& frames = acknowledged.frames;
  EXPECT_TRUE(std::equal(published.work_frames.begin(), published.work_frames.end(),
                         frames.rows().begin(), frames.rows().end()));
  EXPECT_EQ(published.work_frame, frames.active());
  EXPECT_EQ(published.tool_file, acknowledged.tools.value_or(""));
  EXPECT_EQ(published.soft_limits, acknowledged.limits);
}

TEST(SetUpKill, LeavesTheOldSetUpOrTheNewOneAtAnyInstant) {
  const int kills = number_of("MERIDIAN_SETUP_KILLS", 8);
  const auto seed = number_of<std::uint32_t>("MERIDIAN_SETUP_SEED", 20261125);
  std::printf("seed %u\n", seed);
  std::mt19937 engine(seed);
  Plant plant;
  telemetry::SetUp acknowledged;
  int kept = 0, changed = 0;
  for (int n = 1; n <= kills; ++n) {
    SCOPED_TRACE(testing::Message() << "kill " << n);
    plant.start_service();
    ASSERT_TRUE(plant.runs_until([](const dds::Status& status) { return status.cycles_run > 0; },
                                 milliseconds(20'000)))
        << plant.service().said();
    expect_reported(reported_by(plant), acknowledged);
    // A word for the table, one for the row in force, one for tools, one for limits or a keep-out
    // box, in turns.
    const int number = 1 + n / 4 % 3;
    const bool is_select = n % 4 == 1 && acknowledged.frames.find(number) != nullptr;
    const FrameOrder order = order_of(is_select ? FrameWord::kSelect : FrameWord::kSet, number, n);
    SetUpOperator anna(plant, 100 + static_cast<std::uint64_t>(n));
    telemetry::SetUp asked = acknowledged;
    if (n % 16 == 7) {
      LimitsOrder tip;
      tip.word = LimitsWord::kTip;
      tip.box.min = {-1.0 / 3.0 * n, -500, -500};
      tip.box.max = {1.0 / 3.0 * n, 500, 500};
      ASSERT_EQ(asked.limits.apply(tip, config::load_machine(plant.machine())), LimitsFault::kNone);
      anna.say(tip, plant.status());
    } else if (n % 8 == 7) {
      LimitsOrder box;
      box.word = LimitsWord::kKeepOut;
      box.box.name = {static_cast<char>('a' + n / 8 % 8)};
      box.box.joints = 0b101;
      box.box.min = {1.0 / 3.0 * n, 0, -5};
      box.box.max = {1.0 / 3.0 * n + 1, 0, 5};
      ASSERT_EQ(asked.limits.apply(box, config::load_machine(plant.machine())), LimitsFault::kNone);
      anna.say(box, plant.status());
    } else if (n % 4 == 3) {
      const LimitsOrder shrink{LimitsWord::kSet, static_cast<std::uint8_t>(n % 5), -1, 1e-3 * n};
      ASSERT_TRUE(asked.limits.put(shrink.joint, shrink.min, shrink.max));
      anna.say(shrink, plant.status());
    } else if (n % 4 == 2) {
      asked.tools = tools_of(n);
      anna.say(*asked.tools, plant.status());
    } else {
      ASSERT_EQ(asked.frames.apply(order), FrameFault::kNone);
      anna.say(order, plant.status());
    }
    const int wait_us = std::uniform_int_distribution<int>(0, 150'000)(engine);
    std::this_thread::sleep_for(std::chrono::microseconds(wait_us));
    plant.service().send_signal(SIGKILL);
    ASSERT_TRUE(plant.service().wait(milliseconds(2000)));
    const telemetry::SetUp left = on_disk(plant);
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
