// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/draws.hpp"
#include "unit/daemon/rehearsal.hpp"

/// How many cycles pass between what happens and what is done about it, at random moments of a cut:
/// cycle and drives in step, so that the figures are the machine's own, without wire and clock.
namespace meridian::test {
namespace {

const Vector3 kReactionCut_mm{60, 0, 0};  // 0.72 s: from rest to 100 mm/s to rest

/// Percentiles of `cycles`, sorted by it; prints them.
struct Reaction {
  Reaction(const char* what, std::vector<int> counted) : cycles(std::move(counted)) {
    std::sort(cycles.begin(), cycles.end());
    std::printf("%s: %zu times, cycles p50 %d, p99 %d, most %d\n", what, cycles.size(), at(50),
                at(99), max());
  }
  [[nodiscard]] int at(int percent) const {
    return cycles[std::min(cycles.size() - 1,
                           cycles.size() * static_cast<std::size_t>(percent) / 100)];
  }
  [[nodiscard]] int min() const { return cycles.front(); }
  [[nodiscard]] int max() const { return cycles.back(); }

  std::vector<int> cycles;
};

/// The machine, so long in the cut.
std::unique_ptr<Rehearsal> cutting(double seconds) {
  auto plant = std::make_unique<Rehearsal>();
  EXPECT_TRUE(plant->enable());
  plant->plan.cut(kReactionCut_mm, kRehearsalLimits);
  plant->plan.barrier(TimeKind::kEnd);
  plant->run(seconds);
  return plant;
}

/// Counts in `count` at 200 moments of the cut, from its first cycle on to 0.65 s.
Reaction count_reactions(const char* what, const std::function<int(Rehearsal&)>& count) {
  std::mt19937 engine(20260412);
  std::uniform_real_distribution<double> moment_s(0.005, 0.65);
  std::vector<int> cycles;
  for (int n = 0; n < draws(200); ++n) {
    const double moment = moment_s(engine);
    SCOPED_TRACE(testing::Message() << what << " after " << moment << " s");
    const auto plant = cutting(moment);
    EXPECT_EQ(plant->world.now(), State::kRunning);
    cycles.push_back(count(*plant));
  }
  return {what, cycles};
}

/// Cycles until `is_it` after each, at most 1000.
int cycles_until(Rehearsal& plant, const std::function<bool()>& is_it) {
  for (int n = 1; n <= 1000; ++n) {
    plant.cycle();
    if (is_it()) return n;
  }
  return 1000;
}

TEST(Reaction, OfAHoldIsADeceleratingSetpointInTheCycleThatSeesIt) {
  const auto undisturbed = cutting(0.85);
  const auto& plan = undisturbed->world.records;
  const auto reaction =
      count_reactions("hold seen to first decelerating setpoint", [&](auto& plant) {
        const auto lags = [&] {
          const std::size_t n = plant.world.records.size() - 1;
          return plant.world.records[n].plan_time_s < plan[n].plan_time_s &&
                 plant.world.records[n].joints != plan[n].joints;
        };
        EXPECT_FALSE(lags()) << "as planned until then";
        plant.say(Verb::kHold);
        return lags() ? 0 : cycles_until(plant, lags);
      });
  EXPECT_EQ(reaction.max(), 0);
}

TEST(Reaction, OfDrivesThatDieIsAFaultStopWhenTheirLastReportIsTooOld) {
  const auto reaction = count_reactions("drives dead to FaultStop", [](auto& plant) {
    plant.inject("dead");
    return cycles_until(plant, [&] { return plant.world.now() == State::kFaultStop; });
  });
  const auto timeout = static_cast<int>(std::lround(CycleOptions{}.feedback_timeout_s * 1e3));
  EXPECT_GE(reaction.min(), timeout);
  EXPECT_LE(reaction.max(), timeout + 1);
}

TEST(Reaction, OfADriveThatFaultsOrOfTheStopInputIsAFaultStopInTheCycleThatSeesTheReport) {
  for (const char* what : {"fault:b3", "unpowered:theta1", "mute:b2", "nan:theta2", "emergency"}) {
    const auto reaction = count_reactions(what, [what](auto& plant) {
      plant.inject(what);
      return cycles_until(plant, [&] { return plant.world.now() == State::kFaultStop; });
    });
    EXPECT_LE(reaction.max(), 2) << what;
  }
}

TEST(Reaction, OfDrivesThatGetNoSetpointsIsTheirRampBehindTheBridge) {
  const auto reaction = count_reactions("setpoints lost to the drives' ramp", [](auto& plant) {
    plant.inject("deaf=1000");
    return cycles_until(plant,
                        [&] { return plant.group.drive(0).state() == DriveState::kFaultReaction; });
  });
  EXPECT_EQ(reaction.min(), machine_at_begin().bridge_cycles + 1);
  EXPECT_EQ(reaction.max(), machine_at_begin().bridge_cycles + 1);
}

TEST(Reaction, OfAStationThatSendsNothingMoreIsStarvingWithTheFirstDeceleratingSetpoint) {
  std::mt19937 engine(20260412);
  std::uniform_real_distribution<double> cruise_s(0.001, 0.4);
  std::vector<int> cycles;
  for (int n = 0; n < draws(200); ++n) {
    const double cruise = cruise_s(engine);
    SCOPED_TRACE(testing::Message() << "cruise of " << cruise << " s");
    auto plant = std::make_unique<Rehearsal>();
    ASSERT_TRUE(plant->enable());
    plant->plan.cut_with_tail({200, 0, 0}, kRehearsalLimits, cruise);
    plant->run(0.12);  // after the acceleration, which takes 0.117 s
    const auto speed = [&] { return plant->world.state.on_path.ds; };
    double last = speed();
    for (int k = 0; k < 1000 && speed() >= last - 1e-9; ++k) {
      last = speed();
      plant->cycle();
    }
    const int late = plant->world.now() == State::kStarving ? 0 : cycles_until(*plant, [&] {
      return plant->world.now() == State::kStarving;
    });
    cycles.push_back(late);
    ASSERT_TRUE(plant->until(State::kStarved, 1));
    EXPECT_LE(plant->deviation(0), 1e-9);
  }
  const Reaction reaction("plan at its end to Starving", cycles);
  EXPECT_EQ(reaction.max(), 0);
}

}  // namespace
}  // namespace meridian::test
