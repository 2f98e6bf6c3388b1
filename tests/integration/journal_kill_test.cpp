// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <thread>

#include "integration/live_run.hpp"
#include "integration/plant.hpp"
#include "integration/witness.hpp"
#include "service/recording/telemetry/journal/journal.hpp"
#include "support/draws.hpp"

/// A service that is killed while it writes its journal. MERIDIAN_JOURNAL_KILLS=100 in the
/// environment for more of it, MERIDIAN_JOURNAL_SEED for others.
namespace meridian::test {
namespace {

/// The position is some 20 ms old at most, while an entry is being synced as much more as that
/// takes; a busy host takes its time.
constexpr double kOldest_s = 0.5;
/// Rows of a recording that a kill may cost.
constexpr double kUnrecorded_s = 0.5;

[[nodiscard]] std::int64_t steady_now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

class JournalKill : public testing::Test {
 protected:
  void start_service() { plant.start_service({"--service", service_file(plant)}); }
  void run_program() {
    ASSERT_TRUE(eventually(
        [&] {
          const auto reset = plant.say(Verb::kReset);
          const auto enable = plant.say(Verb::kEnable);
          return reset && enable && plant.wait_for(State::kReady, milliseconds(500));
        },
        milliseconds(15'000)))
        << plant.standing();
    ASSERT_TRUE(plant.stream(small_program(400, 1500, 0.5), [](const stream::Station& station) {
      return station.state() == stream::StationState::kComplete;
    })) << plant.station().message();
    ASSERT_TRUE(plant.runs_until([](const auto& s) { return s.state == State::kLoaded; }))
        << plant.standing();
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
    ASSERT_TRUE(eventually([&] { return witness.newest().line > 1; }, milliseconds(8000)))
        << plant.standing();
  }
  [[nodiscard]] double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  void sleep(double seconds) {
    std::this_thread::sleep_for(std::chrono::microseconds(std::llround(1e6 * seconds)));
  }
  /// The journal that is on the disk, whole.
  [[nodiscard]] telemetry::JournalEntry journal() const {
    telemetry::Journal left(plant.state(), "lai");
    const auto entry = left.read();
    EXPECT_TRUE(entry.has_value()) << left.complaint();
    return entry.value_or(telemetry::JournalEntry{});
  }
  /// The cycle of the last whole row that is on the disk; 0: there is none.
  [[nodiscard]] std::uint64_t recorded_cycle() const {
    std::ifstream file(plant.recording());
    std::uint64_t last = 0;
    for (std::string line; std::getline(file, line) && !file.eof();) {
      last = std::max<std::uint64_t>(last, std::strtoull(line.c_str(), nullptr, 10));
    }
    return last;
  }

  const std::uint32_t seed = number_of<std::uint32_t>("MERIDIAN_JOURNAL_SEED", 20260412);
  std::mt19937 engine{seed};
  Plant plant;
  Witness witness{plant.participant()};
};

TEST_F(JournalKill, LeavesAWholeJournalThatIsASecondOldAtMostAndNotAheadOfTheCut) {
  const int kills = number_of("MERIDIAN_JOURNAL_KILLS", 2);
  std::printf("seed %u\n", seed);
  start_service();
  plant.start_drives();
  double oldest_s = 0;
  for (int n = 0; n < kills; ++n) {
    SCOPED_TRACE(testing::Message() << "kill " << n);
    ASSERT_NO_FATAL_FAILURE(run_program());
    sleep(draw(0.2, 2.5));
    // Every rest is written at once: half of the kills come while that is done.
    const bool is_at_rest = n % 2 == 1;
    if (is_at_rest) {
      ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kHold));
      sleep(draw(0, 0.15));
    }
    const std::uint64_t id = plant.status().service_id;
    const std::int64_t killed_ns = steady_now_ns();
    plant.service().send_signal(SIGKILL);
    ASSERT_TRUE(plant.service().wait(milliseconds(2000)));
    const telemetry::JournalEntry entry = journal();
    const std::uint64_t recorded_until = recorded_cycle();
    const auto sent = witness.take();
    ASSERT_FALSE(sent.empty());
    const auto recorded = std::find_if(sent.begin(), sent.end(), [&](const Setpoint& setpoint) {
      return setpoint.cycle > recorded_until;
    });
    if (recorded != sent.end()) {
      const double lost_s = 1e-9 * static_cast<double>(killed_ns - recorded->due_ns);
      EXPECT_LE(lost_s, kUnrecorded_s) << "recorded up to cycle " << recorded_until;
    }

    start_service();
    ASSERT_TRUE(eventually([&] { return plant.status().service_id != id; }, milliseconds(8000)));
    EXPECT_EQ(plant.status().state, State::kOff);
    const std::string message = plant.status().message;
    EXPECT_NE(message.find("line " + std::to_string(entry.line)), std::string::npos) << message;
    EXPECT_EQ(message.rfind("last program: small program", 0), 0U) << message;
    EXPECT_EQ(plant.service().said().find("put aside"), std::string::npos);

    EXPECT_LE(entry.line, sent.back().line) << "ahead of what was cut: blocks would be lost";
    const auto next = std::find_if(sent.begin(), sent.end(), [&](const Setpoint& setpoint) {
      return setpoint.line > entry.line;
    });
    if (next == sent.end()) continue;
    const double age_s = 1e-9 * static_cast<double>(killed_ns - next->due_ns);
    oldest_s = std::max(oldest_s, age_s);
    EXPECT_LE(age_s, kOldest_s) << message << "; sent were lines up to " << sent.back().line;
  }
  std::printf("%d kills: what the journal did not hold was begun %.3f s before at most\n", kills,
              oldest_s);
}

}  // namespace
}  // namespace meridian::test
