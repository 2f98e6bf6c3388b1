// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/flight_store.hpp"

#include <gtest/gtest.h>

#include "flown.hpp"

namespace meridian::telemetry {
namespace {

TEST(FlightStore, FreezesBehindTheStopAndKeepsTheRowsBefore) {
  FlightStore store(100, 10);
  Flown run;
  run.cycles(store, 100, State::kRunning);
  store.take(run.alarm(Alarm::kActionFailed, 0), true);  // holds the program, and is no fault
  run.cycles(store, 150, State::kRunning);
  store.take(run.alarm(Alarm::kFollowingError, 3), true);
  run.cycles(store, 20, State::kFaultStop);
  run.cycles(store, 10, State::kFault);
  EXPECT_FALSE(store.is_frozen());
  run.cycles(store, 1, State::kFault);
  ASSERT_TRUE(store.is_frozen());
  run.cycles(store, 50, State::kOff);
  ASSERT_EQ(store.size(), 100U);
  EXPECT_EQ(store.row(0).record.setpoint.cycle, 182U);
  EXPECT_EQ(store.row(99).record.setpoint.cycle, 281U);
  EXPECT_EQ(store.row(99).drives.position[0], 281);
  EXPECT_EQ(store.fault().record.setpoint.cycle, 251U);
  ASSERT_EQ(store.alarm_count(), 1U);
  EXPECT_EQ(store.alarm(0).cycle, 251U);
  EXPECT_EQ(store.alarm(0).joint, 3);
}

TEST(FlightStore, KeepsHalfOfItsRowsFromBeforeTheFaultHoweverLongTheStop) {
  FlightStore store(100, 10);
  Flown run;
  run.cycles(store, 200, State::kRunning);
  run.cycles(store, 300, State::kFaultStop);
  ASSERT_TRUE(store.is_frozen());
  EXPECT_EQ(store.fault().record.setpoint.cycle, 201U);
  EXPECT_LE(store.row(0).record.setpoint.cycle, 152U);
}

TEST(FlightStore, CountsAFaultThatFindsItFrozenAndBeginsAnewWhenItThaws) {
  FlightStore store(100, 10);
  Flown run;
  run.cycles(store, 30, State::kFaultStop);
  run.cycles(store, 30, State::kFault);
  ASSERT_TRUE(store.is_frozen());
  run.cycles(store, 30, State::kOff);
  EXPECT_EQ(store.faults_missed(), 0U);
  run.cycles(store, 30, State::kFault);
  EXPECT_EQ(store.faults_missed(), 1U);
  store.thaw();
  run.cycles(store, 60, State::kFault);
  EXPECT_FALSE(store.is_frozen()) << "the fault in which it was thawed is no new one";
  run.cycles(store, 20, State::kOff);
  run.cycles(store, 20, State::kFault);
  ASSERT_TRUE(store.is_frozen());
  EXPECT_EQ(store.row(0).record.setpoint.cycle, 121U);
}

TEST(FlightStore, FreezesTheFirstOfTwoFaultsWhereTheSecondBeginsAndCountsThat) {
  FlightStore store(100, 10);
  Flown run;
  run.cycles(store, 50, State::kRunning);
  run.cycles(store, 3, State::kFaultStop);
  run.cycles(store, 3, State::kFault);
  run.cycles(store, 2, State::kOff);
  EXPECT_FALSE(store.is_frozen());
  run.cycles(store, 1, State::kFault);
  EXPECT_TRUE(store.is_frozen());
  EXPECT_EQ(store.faults_missed(), 1U);
  EXPECT_EQ(store.size(), 58U);
  EXPECT_EQ(store.fault().record.setpoint.cycle, 51U);
}

TEST(FlightStore, FreezesWhatIsThereWhereTheServiceEndsInAFault) {
  FlightStore store(100, 10);
  Flown run;
  run.cycles(store, 30, State::kRunning);
  store.finish();
  EXPECT_FALSE(store.is_frozen()) << "there was none";
  run.cycles(store, 3, State::kFaultStop);
  store.finish();
  ASSERT_TRUE(store.is_frozen());
  EXPECT_EQ(store.size(), 33U);
}

TEST(FlightStore, OfNoRowsKeepsNothing) {
  FlightStore store(0, 10);
  Flown run;
  run.cycles(store, 100, State::kFault);
  store.finish();
  EXPECT_FALSE(store.is_frozen());
}

}  // namespace
}  // namespace meridian::telemetry
