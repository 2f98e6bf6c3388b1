// SPDX-License-Identifier: Apache-2.0
#include "unit/daemon/rehearsal.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <ostream>
#include <string>

/// Every fault that simulated drives can be given, while the cycle cuts:
/// cycle, drives and what joins them, without a wire and without a clock.
namespace meridian::test {
namespace {

struct Rehearsed {
  const char* injection;  ///< "*" is the drive that moves fastest
  Alarm alarm;
  Alarm or_alarm;   ///< where drive and service see it in the same cycle
  double within_s;  ///< until FaultStop
  bool names_drive;
};

void PrintTo(const Rehearsed& rehearsed, std::ostream* out) { *out << rehearsed.injection; }

class RehearsedFault : public testing::TestWithParam<Rehearsed> {};

TEST_P(RehearsedFault, StopsOnThePathIsReportedAndIsOverWhenItIsMended) {
  const Rehearsed& expected = GetParam();
  auto plant = std::make_unique<Rehearsal>();
  plant->start();
  const std::size_t first = plant->world.records.size();
  plant->inject(expected.injection);
  ASSERT_TRUE(plant->until(State::kFaultStop, expected.within_s)) << "nobody saw it";
  const Alarm alarm = plant->world.state.alarm;
  EXPECT_TRUE(alarm == expected.alarm || alarm == expected.or_alarm) << static_cast<int>(alarm);
  if (expected.names_drive) {
    EXPECT_EQ(plant->world.last(EventCode::kAlarm).b, static_cast<std::uint64_t>(plant->injected));
  }
  ASSERT_TRUE(plant->until(State::kFault, 2));
  EXPECT_LE(plant->deviation(first), 1e-9) << "mm off the path";
  EXPECT_LE(plant->acceleration(first), 1 + 1e-6);
  EXPECT_EQ(plant->world.records.back().setpoint.flags & kSetpointEnabled, 0);

  plant->mend();
  EXPECT_TRUE(plant->do_drives_stand());
  plant->say(Verb::kReset);
  ASSERT_EQ(plant->world.now(), State::kOff);
  EXPECT_TRUE(plant->enable()) << "it works again";
}

std::string name_of_rehearsal(const testing::TestParamInfo<Rehearsed>& info) {
  const char* text = info.param.injection;
  return std::string(text, std::strcspn(text, ":="));
}

INSTANTIATE_TEST_SUITE_P(
    Of, RehearsedFault,
    testing::Values(
        Rehearsed{"fault:theta2", Alarm::kDriveFault, Alarm::kDriveFault, 0.01, true},
        Rehearsed{"blocked:*", Alarm::kFollowingError, Alarm::kDriveFault, 0.2, true},
        Rehearsed{"silence", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.03, false},
        Rehearsed{"emergency", Alarm::kEmergencyStop, Alarm::kEmergencyStop, 0.01, false},
        Rehearsed{"dead", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.03, false},
        Rehearsed{"unpowered:b2", Alarm::kDriveFault, Alarm::kDriveFault, 0.01, true},
        Rehearsed{"unreferenced:b4", Alarm::kReferenceLost, Alarm::kReferenceLost, 0.01, true},
        Rehearsed{"mute:theta1", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.01, true},
        Rehearsed{"frozen:*", Alarm::kFollowingError, Alarm::kFollowingError, 0.2, true},
        Rehearsed{"nan:theta1", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.01, true},
        Rehearsed{"spike:theta2=3", Alarm::kFollowingError, Alarm::kFollowingError, 0.01, true},
        Rehearsed{"lag:*=500", Alarm::kFollowingError, Alarm::kDriveFault, 0.3, true},
        Rehearsed{"untold", Alarm::kSetpointsUnheard, Alarm::kSetpointsUnheard, 0.04, false},
        Rehearsed{"stale=100", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.03, false},
        Rehearsed{"deaf=100", Alarm::kDriveFault, Alarm::kDriveFault, 0.02, false},
        Rehearsed{"late=20", Alarm::kDriveFault, Alarm::kDriveFault, 0.02, false}),
    name_of_rehearsal);

TEST(RehearsedTrouble, OfSetpointsThatTheDrivesBridgeStopsNothing) {
  auto plant = std::make_unique<Rehearsal>();
  plant->start();
  plant->inject("deaf=3");
  plant->wait(0.2);
  EXPECT_EQ(plant->world.now(), State::kRunning);
  EXPECT_EQ(plant->group.periods_bridged(), 3U);
}

/// Each for itself, while the machine cuts: reports that are old, doubled or out of order.
TEST(RehearsedTrouble, OfReportsThatComeALittleLateTwiceOrOutOfOrderStopsNothing) {
  for (const char* trouble : {"stale=10", "doubled", "swapped"}) {
    SCOPED_TRACE(trouble);
    auto plant = std::make_unique<Rehearsal>();
    plant->start();
    const std::size_t first = plant->world.records.size();
    plant->inject(trouble);
    plant->wait(0.3);
    EXPECT_EQ(plant->world.now(), State::kRunning);
    EXPECT_LE(plant->deviation(first), 1e-9) << "mm off the path";
    EXPECT_LE(plant->acceleration(first), 1 + 1e-6);
  }
}

TEST(RehearsedTrouble, OfAReferenceLostAtRestIsReportedAtTheStart) {
  auto plant = std::make_unique<Rehearsal>();
  ASSERT_TRUE(plant->enable());
  plant->plan.cut({200, 0, 0}, kRehearsalLimits);
  ASSERT_TRUE(plant->until(State::kLoaded, 1));
  plant->inject("unreferenced:b2");
  plant->wait(0.1);
  EXPECT_EQ(plant->world.now(), State::kLoaded);
  plant->say(Verb::kStart);
  EXPECT_EQ(plant->world.now(), State::kLoaded);
  EXPECT_EQ(static_cast<Refusal>(plant->world.last(EventCode::kRefused).x),
            Refusal::kNotReferenced);
}

TEST(RehearsedTrouble, OfADriveThatStandsStillAndReportsTheSameForEverIsSeenWhenItMoves) {
  auto plant = std::make_unique<Rehearsal>();
  ASSERT_TRUE(plant->enable());
  plant->inject("frozen:b3");
  plant->inject("frozen:b2");
  plant->inject("frozen:b4");
  plant->wait(0.2);
  EXPECT_EQ(plant->world.now(), State::kReady);
  plant->plan.cut({200, 0, 0}, kRehearsalLimits);
  ASSERT_TRUE(plant->until(State::kLoaded, 1));
  plant->say(Verb::kStart);
  ASSERT_TRUE(plant->until(State::kFault, 2));
  EXPECT_EQ(plant->world.state.alarm, Alarm::kFollowingError);
}

}  // namespace
}  // namespace meridian::test
