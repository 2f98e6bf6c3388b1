// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/master.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace meridian::drive {
namespace {

using State = MasterPin::State;
constexpr Master kFirst{41, 7}, kOther{42, 8};

/// A pin that has come to `state` with kFirst for its master.
MasterPin pin_in(State state) {
  MasterPin pin;
  if (state == State::kFree) return pin;
  EXPECT_TRUE(pin.obeys(kFirst));
  if (state == State::kGone) pin.work(false, false);
  EXPECT_EQ(pin.state(), state);
  return pin;
}

struct Transition {
  const char* what;
  State from;
  bool is_there, are_off;
  State to;
};

TEST(MasterPin, WorksEveryPeriodByThisTable) {
  const std::vector<Transition> table{
      {"nobody", State::kFree, false, false, State::kFree},
      {"nobody, off", State::kFree, false, true, State::kFree},
      {"free, whoever is there", State::kFree, true, false, State::kFree},
      {"free, whoever is there, off", State::kFree, true, true, State::kFree},
      {"on", State::kPinned, true, false, State::kPinned},
      {"off, and there", State::kPinned, true, true, State::kPinned},
      {"died while on", State::kPinned, false, false, State::kGone},
      {"ended while off", State::kPinned, false, true, State::kFree},
      {"drives ramp down", State::kGone, false, false, State::kGone},
      {"came back in time", State::kGone, true, false, State::kPinned},
      {"came back when they were off", State::kGone, true, true, State::kPinned},
      {"drives are off", State::kGone, false, true, State::kFree},
  };
  for (const Transition& row : table) {
    MasterPin pin = pin_in(row.from);
    pin.work(row.is_there, row.are_off);
    EXPECT_EQ(pin.state(), row.to) << row.what;
    EXPECT_EQ(pin.master(), row.to == State::kFree ? Master{} : kFirst) << row.what;
  }
}

TEST(MasterPin, ObeysDriveCommandsByThisTable) {
  struct Row {
    const char* what;
    State from;
    Master sender;
    bool is_obeyed;
    State to;
  };
  const std::vector<Row> table{
      {"the first", State::kFree, kFirst, true, State::kPinned},
      {"the first, whose participant is not known", State::kFree, {0, 7}, false, State::kFree},
      {"the first, of no service", State::kFree, {41, 0}, false, State::kFree},
      {"the master", State::kPinned, kFirst, true, State::kPinned},
      {"another one", State::kPinned, kOther, false, State::kPinned},
      {"another one with its id", State::kPinned, {42, 7}, false, State::kPinned},
      {"its participant with another id", State::kPinned, {41, 8}, false, State::kPinned},
      {"nobody with its id", State::kPinned, {0, 7}, false, State::kPinned},
      {"the master, back", State::kGone, kFirst, true, State::kPinned},
      {"another one while drives ramp down", State::kGone, kOther, false, State::kGone},
      {"another one with its id, so too", State::kGone, {42, 7}, false, State::kGone},
  };
  for (const Row& row : table) {
    MasterPin pin = pin_in(row.from);
    EXPECT_EQ(pin.obeys(row.sender), row.is_obeyed) << row.what;
    EXPECT_EQ(pin.state(), row.to) << row.what;
    EXPECT_EQ(pin.master(), row.to == State::kFree ? Master{} : kFirst) << row.what;
  }
}

TEST(MasterPin, TakesSetpointsOfTheMastersParticipantAlone) {
  EXPECT_FALSE(pin_in(State::kFree).is_master(0)) << "nobody is no master";
  EXPECT_FALSE(pin_in(State::kFree).is_master(41));
  for (const State state : {State::kPinned, State::kGone}) {
    EXPECT_TRUE(pin_in(state).is_master(41));
    EXPECT_FALSE(pin_in(state).is_master(42));
    EXPECT_FALSE(pin_in(state).is_master(0));
  }
}

TEST(MasterPin, ObeysTheNextOneWhenTheFirstIsGoneAndDrivesAreOff) {
  MasterPin pin = pin_in(State::kGone);
  pin.work(false, true);
  EXPECT_TRUE(pin.obeys(kOther));
  EXPECT_EQ(pin.master(), kOther);
  EXPECT_FALSE(pin.obeys(kFirst)) << "who comes back late finds another master";
}

}  // namespace
}  // namespace meridian::drive
