// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/fault_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace meridian::soak {
namespace {

TEST(Faults, AreExplainedByTheirKindTheirDriveAndTheirTime) {
  const Planned fault{Mishap::kDriveFault, 20, 0, 3};
  EXPECT_TRUE(explains(fault, 20, Alarm::kDriveFault, 3));
  EXPECT_FALSE(explains(fault, 20, Alarm::kDriveFault, 2));
  EXPECT_FALSE(explains(fault, 19, Alarm::kDriveFault, 3));
  EXPECT_FALSE(explains(fault, 20, Alarm::kFollowingError, 3));
  const Planned blocked{Mishap::kDriveBlocked, 20, 0, 3};
  EXPECT_TRUE(explains(blocked, 25, Alarm::kFollowingError, 3));
  EXPECT_TRUE(explains(blocked, 25, Alarm::kDriveFault, 3));
  EXPECT_FALSE(explains(blocked, 25, Alarm::kTravel, 3));
  EXPECT_TRUE(explains({Mishap::kDrivesSilent, 20, 0, 0}, 20, Alarm::kFeedbackLost, 0));
  EXPECT_TRUE(explains({Mishap::kEmergencyStop, 20, 0, 0}, 20, Alarm::kEmergencyStop, 0));
  for (const Mishap mishap : {Mishap::kHold, Mishap::kAbort, Mishap::kServiceDies}) {
    EXPECT_FALSE(explains({mishap, 0, 0, 0}, 20, Alarm::kDriveFault, 0)) << word(mishap);
  }
}

class FaultCheckTest : public testing::Test {
 protected:
  std::optional<FaultCheck::Cause> see(double now_s, State state, Alarm alarm = Alarm::kNone,
                                       const Witness& witness = {}) {
    dds::Status status;
    status.time_ns = ns(now_s);
    status.state = state;
    status.alarm = alarm;
    return check_.see(status, now_s, witness);
  }
  /// A processor was away for `length_s`, until `end_s`.
  static Witness away(double length_s, double end_s) {
    return {.stalls = {{ns(end_s), ns(length_s), 0}}};
  }
  static std::int64_t ns(double s) { return std::llround(s * 1e9); }
  using Cause = FaultCheck::Cause;
  FaultCheck check_;
};

TEST_F(FaultCheckTest, CountsTheTimeThatDrivesWereEnabled) {
  check_.begin_drives(Planned{Mishap::kDrivesSilent, 10, 0, 0});
  for (int life = 0; life < 2; ++life) {  // off for 100 s between two times of 6 s
    EXPECT_FALSE(see(100 * life, State::kEnabling));
    EXPECT_FALSE(see(100 * life + 6, State::kRunning));
    check_.lose_service();
  }
  EXPECT_FALSE(see(200, State::kFaultStop, Alarm::kFeedbackLost));
  EXPECT_EQ(see(201, State::kFault, Alarm::kDriveFault), Cause::kInjected) << "the first counts";
  EXPECT_FALSE(see(202, State::kFault, Alarm::kDriveFault)) << "once for each";
  EXPECT_FALSE(see(203, State::kOff));
  EXPECT_FALSE(check_.is_checked());
  check_.begin_drives(Planned{Mishap::kDrivesSilent, 10, 0, 0});
  EXPECT_FALSE(see(204, State::kEnabling));
  EXPECT_EQ(see(206, State::kFault, Alarm::kFeedbackLost), Cause::kUnprovoked);
}

TEST_F(FaultCheckTest, FindsNoExcuseWhereNothingIsPlanned) {
  EXPECT_FALSE(see(0, State::kRunning));
  EXPECT_EQ(see(100, State::kFault, Alarm::kFollowingError), Cause::kUnprovoked);
}

TEST_F(FaultCheckTest, BlamesTheHostOnlyWhereAProcessorWasSeenToBeAway) {
  check_.begin_drives(Planned{Mishap::kDriveFault, 90, 0, 2});
  const auto fault_after = [&](Alarm alarm, const Witness& witness) {
    EXPECT_FALSE(see(0, State::kRunning));
    return see(1, State::kFault, alarm, witness);
  };
  EXPECT_EQ(fault_after(Alarm::kPeriodsLost, away(0.06, 1)), Cause::kHost);
  EXPECT_EQ(fault_after(Alarm::kFeedbackLost, away(0.11, 1)), Cause::kHost);
  EXPECT_EQ(fault_after(Alarm::kFollowingError, away(0.06, 1)), Cause::kHost);
  EXPECT_EQ(fault_after(Alarm::kPeriodsLost, away(0.03, 1)), Cause::kUnprovoked);
  EXPECT_EQ(fault_after(Alarm::kFeedbackLost, away(0.03, 1)), Cause::kUnprovoked);
  EXPECT_EQ(fault_after(Alarm::kPeriodsLost, {.is_watched = false}), Cause::kUnwatched);
  EXPECT_EQ(fault_after(Alarm::kTravel, {.is_watched = false}), Cause::kUnprovoked);
}

TEST_F(FaultCheckTest, BlamesTheHostForAShortStallWhereDrivesBridgeLess) {
  const auto fault_after = [&](double bridge_s, const Witness& witness) {
    check_ = FaultCheck(bridge_s);
    EXPECT_FALSE(see(0, State::kRunning));
    return see(1, State::kFault, Alarm::kPeriodsLost, witness);
  };
  EXPECT_EQ(fault_after(0.003, away(0.003, 1)), Cause::kHost);
  EXPECT_EQ(fault_after(0.003, away(0.0015, 1)), Cause::kUnprovoked);
  EXPECT_EQ(fault_after(0.05, away(0.003, 1)), Cause::kUnprovoked);
}

TEST_F(FaultCheckTest, BlamesTheHostForADriveFaultOnlyWhereTheDriveMissedSetpoints) {
  const auto fault_after = [&](const Witness& witness) {
    EXPECT_FALSE(see(0, State::kReady));
    return see(1, State::kFault, Alarm::kDriveFault, witness);
  };
  const auto missing = [](Witness witness) {
    witness.misses_setpoints = true;
    return witness;
  };
  EXPECT_EQ(fault_after(missing(away(0.06, 1))), Cause::kHost);
  EXPECT_EQ(fault_after(missing(away(0.03, 1))), Cause::kUnprovoked);
  EXPECT_EQ(fault_after(away(0.11, 1)), Cause::kUnprovoked);
}

TEST_F(FaultCheckTest, HearsOfAStallDuringTheStopAndForgetsItBehindIt) {
  EXPECT_FALSE(see(0, State::kRunning));
  EXPECT_FALSE(see(1, State::kFaultStop, Alarm::kFeedbackLost));
  EXPECT_FALSE(see(1.1, State::kFaultStop, Alarm::kFeedbackLost, away(0.11, 1)));
  EXPECT_EQ(see(2.5, State::kFault, Alarm::kFeedbackLost), Cause::kHost);
  EXPECT_NE(check_.describe().find("a processor away for 110 ms"), std::string::npos)
      << check_.describe();
  EXPECT_FALSE(see(3, State::kRunning));
  EXPECT_EQ(see(4, State::kFault, Alarm::kFeedbackLost), Cause::kUnprovoked);
}

TEST_F(FaultCheckTest, FindsNoExcuseInAStallBehindTheBeginOfTheStop) {
  const auto stall_of = [&](double length_s, double end_s) {
    EXPECT_FALSE(see(0, State::kRunning));
    EXPECT_FALSE(see(1, State::kFaultStop, Alarm::kFeedbackLost));
    return see(2, State::kFault, Alarm::kFeedbackLost, away(length_s, end_s));
  };
  EXPECT_EQ(stall_of(0.2, 1.3), Cause::kUnprovoked) << "began 100 ms behind the alarm";
  EXPECT_EQ(stall_of(0.2, 1.17), Cause::kUnprovoked) << "had lasted for 30 ms by then";
  EXPECT_EQ(stall_of(0.2, 1.1), Cause::kHost) << "for 100 ms";
  EXPECT_EQ(stall_of(0.2, -0.5), Cause::kUnprovoked) << "long ago";
}

TEST_F(FaultCheckTest, SeesNoSecondFaultInWhatFollowsFromDrivesThatEnded) {
  check_.begin_drives(Planned{Mishap::kDriveFault, 90, 0, 2});
  EXPECT_FALSE(see(0, State::kRunning));
  check_.lose_drives();
  EXPECT_EQ(see(0.2, State::kFault, Alarm::kFeedbackLost), Cause::kOwnDoing);
}

TEST_F(FaultCheckTest, NamesTheJointOfWhatIsPlannedForOneDriveAlone) {
  const auto described = [&](Mishap mishap) {
    check_.begin_drives(Planned{mishap, 10, 0, 3});
    return check_.describe();
  };
  EXPECT_NE(described(Mishap::kDriveFault).find("planned: drive fault of joint 3 at 10.0 s"),
            std::string::npos);
  EXPECT_NE(described(Mishap::kDrivesSilent).find("planned: drives silent at 10.0 s"),
            std::string::npos);
}

TEST_F(FaultCheckTest, WaitsForTheAlarmThatIsReportedAfterTheState) {
  check_.begin_drives(Planned{Mishap::kEmergencyStop, 1, 0, 0});
  EXPECT_FALSE(see(0, State::kRunning));
  EXPECT_FALSE(see(2, State::kFault));
  EXPECT_FALSE(check_.is_checked());
  EXPECT_EQ(see(2.05, State::kFault, Alarm::kEmergencyStop), Cause::kInjected);
  EXPECT_TRUE(check_.is_checked());
  EXPECT_FALSE(see(3, State::kRunning));
  EXPECT_FALSE(see(4, State::kFault));
  EXPECT_EQ(see(5.1, State::kFault), Cause::kUnprovoked) << "one that is never reported";
}

TEST_F(FaultCheckTest, NamesEveryAlarmAndTheJointOfThoseThatHaveOne) {
  EXPECT_FALSE(see(0, State::kRunning));
  EXPECT_TRUE(see(1, State::kFault, Alarm::kReferenceLost));
  EXPECT_NE(check_.describe().find("alarm: reference_lost of joint 0,"), std::string::npos)
      << check_.describe();
  EXPECT_FALSE(see(2, State::kRunning));
  EXPECT_TRUE(see(3, State::kFault, Alarm::kPeriodsLost));
  EXPECT_NE(check_.describe().find("alarm: periods_lost, "), std::string::npos)
      << check_.describe();
}

TEST_F(FaultCheckTest, KnowsWhatTheSoakDidItself) {
  EXPECT_FALSE(see(0, State::kStarved));
  check_.begin_drives(std::nullopt);
  EXPECT_EQ(see(1, State::kFault, Alarm::kFeedbackLost), Cause::kOwnDoing);
  EXPECT_FALSE(see(2, State::kOff));
  check_.begin_drives(std::nullopt);  // those of a machine that is off miss nobody
  EXPECT_FALSE(see(3, State::kReady));
  EXPECT_EQ(see(4, State::kFault, Alarm::kFeedbackLost), Cause::kUnprovoked);
}

}  // namespace
}  // namespace meridian::soak
