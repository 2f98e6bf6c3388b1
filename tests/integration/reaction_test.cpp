// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "integration/endless_station.hpp"
#include "integration/plant.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/daemon/ports/drive_words.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "support/draws.hpp"

/// How long processes take to react, from the recording and the wire. MERIDIAN_REACTIONS=100 in the
/// environment makes percentiles of it. A busy host makes single times longer: of a few the least
/// alone is bounded from above.
namespace meridian::test {
namespace {

using record::RecordingRow;

[[nodiscard]] std::int64_t monotonic_now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

/// What the recording holds of one death of a station.
struct Starvation {
  double ahead_mm = 0;  ///< path of received blocks in front of the tool at the kill
  double time_ms = -1;  ///< from there to the first cycle in Starving
  double left_mm = 0;   ///< of that path there
  int row = 0;          ///< of that cycle, counted from the kill
  double cruise = 0;    ///< speed of the joints at the kill
  int slower_row = -1;  ///< first one that is slower
  [[nodiscard]] bool is_known() const { return time_ms >= 0 && slower_row >= 0; }
};

class LiveReaction : public testing::Test {
 protected:
  void SetUp() override {
    plant.start_service();
    plant.start_drives();
    ASSERT_TRUE(plant.enable()) << plant.service().said();
  }
  void run_program() {
    ASSERT_TRUE(plant.stream(small_program(250, 120), [](const stream::Station& station) {
      return station.state() == stream::StationState::kComplete;
    })) << plant.station().message();
    ASSERT_TRUE(plant.wait_for(State::kLoaded)) << plant.service().said();
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
    ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.service().said();
  }
  void say(Verb verb, State then) {
    ASSERT_NO_FATAL_FAILURE(plant.must(verb));
    ASSERT_TRUE(plant.wait_for(then)) << plant.service().said();
  }
  void recover() {
    ASSERT_TRUE(plant.wait_for(State::kFault)) << plant.service().said();
    ASSERT_TRUE(eventually([&] {
      const auto reset = plant.say(Verb::kReset);
      return reset && reset->is_accepted && plant.wait_for(State::kOff, milliseconds(300)) &&
             plant.enable();
    })) << plant.service().said();
  }
  /// Some time, of which nobody knows the phase in the cycle.
  void wait_somewhere() {
    std::this_thread::sleep_for(
        std::chrono::microseconds(std::uniform_int_distribution<int>(20'000, 60'000)(engine)));
  }
  /// Ends the service and shows its recording row by row.
  template <class Visit>
  void read_recording(const Visit& visit) {
    plant.service().send_signal(SIGTERM);
    ASSERT_EQ(plant.service().wait(milliseconds(12'000)), 0) << plant.service().said();
    auto reader = record::RecordingReader::open(plant.recording().string(),
                                                config::load_machine(machine_file()));
    ASSERT_TRUE(reader.has_value()) << reader.error().text();
    RecordingRow row;
    for (auto has_row = reader->next(row); has_row && *has_row; has_row = reader->next(row)) {
      visit(row);
    }
  }
  /// When the machine first was in `state` behind each of `asked_ns`, ms behind it.
  [[nodiscard]] std::vector<double> times_until(State state) {
    std::vector<double> times_ms;
    read_recording([&](const RecordingRow& row) {
      if (times_ms.size() == asked_ns.size() || row.state != state) return;
      const std::int64_t asked = asked_ns[times_ms.size()];
      if (row.due_ns >= asked) times_ms.push_back(1e-6 * static_cast<double>(row.due_ns - asked));
    });
    EXPECT_EQ(times_ms.size(), asked_ns.size());
    return times_ms;
  }
  struct Spread {
    double min = 0, middle = 0;  ///< of two in the middle the larger
  };
  static Spread report(const char* what, const char* unit, std::vector<double> values) {
    EXPECT_FALSE(values.empty());
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto at = [&](std::size_t percent) { return values[values.size() * percent / 100]; };
    std::printf("%s: %zu times, %s least %.2f, most %.2f\n", what, values.size(), unit,
                values.front(), values.back());
    if (std::getenv("MERIDIAN_REACTIONS") != nullptr) {
      std::printf("  p50 %.2f, p90 %.2f, p99 %.2f\n", at(50), at(90), at(99));
    }
    return {.min = values.front(), .middle = at(50)};
  }

  const int repetitions = number_of("MERIDIAN_REACTIONS", 2);
  std::mt19937 engine{20260412};
  std::vector<std::int64_t> asked_ns;  ///< when each thing happened
  Plant plant;
};

TEST_F(LiveReaction, OfAHoldIsADeceleratingSetpointWithinTwoCycles) {
  ASSERT_NO_FATAL_FAILURE(run_program());
  for (int n = 0; n < repetitions; ++n) {
    wait_somewhere();
    asked_ns.push_back(monotonic_now_ns());
    ASSERT_NO_FATAL_FAILURE(say(Verb::kHold, State::kHeld));
    ASSERT_NO_FATAL_FAILURE(say(Verb::kResume, State::kRunning));
  }
  ASSERT_NO_FATAL_FAILURE(say(Verb::kAbort, State::kReady));
  std::vector<double> times_ms, cycles;
  int since_seen = -1;  // executed cycles since the one that saw the hold; -1: none to wait for
  State before = State::kOff;
  read_recording([&](const RecordingRow& row) {
    const bool is_seen = row.state == State::kHolding && before != State::kHolding;
    since_seen = is_seen ? 0 : since_seen < 0 ? -1 : since_seen + 1;
    before = row.state;
    if (since_seen < 0 || row.rate >= 1) return;
    cycles.push_back(since_seen);
    times_ms.push_back(1e-6 * static_cast<double>(row.due_ns - asked_ns.at(times_ms.size())));
    since_seen = -1;
  });
  ASSERT_EQ(cycles.size(), asked_ns.size());
  (void)report("hold seen to first decelerating setpoint", "cycles", cycles);
  (void)report("operator's hold to first decelerating setpoint", "ms", times_ms);
  const probe::Budget budget = probe::load_budget("hold_reaction");
  EXPECT_TRUE(budget.is_kept(*std::max_element(cycles.begin(), cycles.end()))) << to_text(budget);
}

TEST_F(LiveReaction, OfDrivesThatAreKilledIsAFaultStopWhenTheirLastReportIsTooOld) {
  constexpr double kFeedbackTimeout_ms = 100;  // of the service file
  for (int n = 0; n < repetitions; ++n) {
    ASSERT_NO_FATAL_FAILURE(run_program());
    wait_somewhere();
    asked_ns.push_back(monotonic_now_ns());
    plant.drives().send_signal(SIGKILL);
    ASSERT_TRUE(plant.drives().wait(milliseconds(2000)));
    ASSERT_TRUE(plant.wait_for(State::kFault)) << plant.service().said();
    EXPECT_EQ(plant.status().alarm, Alarm::kFeedbackLost);
    plant.start_drives();
    ASSERT_NO_FATAL_FAILURE(recover());
  }
  const Spread times = report("drives killed to FaultStop", "ms", times_until(State::kFaultStop));
  EXPECT_GT(times.middle, kFeedbackTimeout_ms - 10);
  EXPECT_LT(times.min, kFeedbackTimeout_ms + 50);
}

TEST_F(LiveReaction, OfAServiceThatIsStoppedIsTheDrivesRampBehindTheBridge) {
  constexpr double kBridge_ms = 50;  // of a service in best effort
  dds::Reader<dds::DriveFeedback> feedback(plant.participant());
  std::vector<double> times_ms;
  for (int n = 0; n < repetitions; ++n) {
    ASSERT_NO_FATAL_FAILURE(run_program());
    wait_somewhere();
    const std::int64_t begun_ns = monotonic_now_ns();
    plant.service().send_signal(SIGSTOP);
    dds::DriveFeedback sample;
    const bool has_ramped = eventually([&] {
      while (feedback.take(sample)) {
        const auto state = drive_state(sample.statusword[0]);
        if (state == DriveState::kFaultReaction || state == DriveState::kFault) {
          times_ms.push_back(1e-6 * static_cast<double>(monotonic_now_ns() - begun_ns));
          return true;
        }
      }
      return false;
    });
    plant.service().send_signal(SIGCONT);
    ASSERT_TRUE(has_ramped) << plant.drives().said();
    ASSERT_NO_FATAL_FAILURE(recover());
    while (feedback.take(sample)) continue;
  }
  const Spread times = report("service stopped to the drives' ramp", "ms", times_ms);
  EXPECT_GT(times.middle, kBridge_ms - 5);
  EXPECT_LT(times.min, kBridge_ms + 50);
}

TEST_F(LiveReaction, OfAStationThatIsKilledIsStarvingNoLaterThanTheFirstSlowerSetpoint) {
  std::vector<double> received_mm;  // x of the last block that came
  const int deaths = std::getenv("MERIDIAN_REACTIONS") != nullptr ? repetitions : 1;
  for (int n = 0; n < deaths; ++n) {
    EndlessStation station(plant);
    const auto is_in = [this](State state) {
      return [this, state] { return plant.status().state == state; };
    };
    ASSERT_TRUE(station.feed_until(is_in(State::kLoaded))) << station.process().said();
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
    ASSERT_TRUE(station.feed_until(is_in(State::kRunning))) << plant.service().said();
    const std::int64_t up_to_speed_ns = monotonic_now_ns() + 250'000'000;
    ASSERT_TRUE(station.feed_until([&] { return monotonic_now_ns() > up_to_speed_ns; }));
    wait_somewhere();
    asked_ns.push_back(monotonic_now_ns());
    station.process().send_signal(SIGKILL);
    ASSERT_TRUE(plant.wait_for(State::kStarved)) << plant.service().said();
    received_mm.push_back(station.x_of(plant.status().blocks_received - 1));
    ASSERT_NO_FATAL_FAILURE(say(Verb::kAbort, State::kReady));
  }
  const MachineModel model = config::load_machine(machine_file());
  std::vector<Starvation> found(asked_ns.size());
  std::size_t k = 0;
  int row_of_kill = -1, row_number = 0;
  read_recording([&](const RecordingRow& row) {
    ++row_number;
    if (k == found.size() || row.due_ns < asked_ns[k]) return;
    Starvation& one = found[k];
    const double left_mm =
        received_mm[k] - forward(model, model.tool_length_mm, row.joints).tip.x();
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) square += row.velocity[i] * row.velocity[i];
    const double speed = std::sqrt(square);
    if (row_of_kill < 0) {
      row_of_kill = row_number;
      one.ahead_mm = left_mm;
      one.cruise = speed;
    }
    // Of the speed: windows of a plan differ by 4e-5 of it, and the jerk of a stop takes 1e-4 of it
    // in its first cycle.
    constexpr double kSlower = 1e-4;
    const bool is_slower = speed < (1 - kSlower) * one.cruise;
    if (is_slower && one.slower_row < 0) one.slower_row = row_number - row_of_kill;
    if (row.state == State::kStarving && one.time_ms < 0) {
      one.time_ms = 1e-6 * static_cast<double>(row.due_ns - asked_ns[k]);
      one.left_mm = left_mm;
      one.row = row_number - row_of_kill;
    }
    if (!one.is_known()) return;
    ++k;
    row_of_kill = -1;
  });
  ASSERT_EQ(k, found.size()) << "every death is followed by Starving";
  std::vector<double> times_ms, ahead_mm, left_mm, cycles;
  for (const Starvation& one : found) {
    times_ms.push_back(one.time_ms);
    ahead_mm.push_back(one.ahead_mm);
    left_mm.push_back(one.left_mm);
    cycles.push_back(one.slower_row - one.row);
    EXPECT_GT(one.row, 0) << "starving while its station lived";
    EXPECT_GE(one.slower_row, one.row) << "slower before the machine says why";
    EXPECT_NEAR(one.cruise, EndlessStation::kFeed_mm_per_s, 0.02 * EndlessStation::kFeed_mm_per_s);
    EXPECT_NEAR(1e-3 * one.time_ms * one.cruise, one.ahead_mm - one.left_mm, 1)
        << "what was received is cut first, at its feed";
  }
  (void)report("station killed to Starving", "ms", times_ms);
  (void)report("received path ahead of the tool when it was killed", "mm", ahead_mm);
  (void)report("received path left at Starving", "mm", left_mm);
  (void)report("Starving to first slower setpoint", "cycles", cycles);
}

}  // namespace
}  // namespace meridian::test
