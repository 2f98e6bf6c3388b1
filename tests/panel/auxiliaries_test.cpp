// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/auxiliaries.hpp"

#include <gtest/gtest.h>

#include "panel/action_samples.hpp"

namespace meridian::panel {
namespace {

TEST(Auxiliaries, SpindleAndCoolantAreWhatWasDone) {
  Auxiliaries auxiliaries;
  auxiliaries.ask(asked(1, ActionKind::kSpindleClockwise, 8000));
  EXPECT_EQ(auxiliaries.waits_for(), "spindle clockwise 8000 rev/min");
  EXPECT_EQ(auxiliaries.spindle(), "") << "nobody has done it yet";
  auxiliaries.answer(answered(1));
  EXPECT_EQ(auxiliaries.waits_for(), "");
  EXPECT_EQ(auxiliaries.spindle(), "spindle clockwise 8000 rev/min");
  auxiliaries.ask(asked(2, ActionKind::kCoolantFlood));
  auxiliaries.answer(answered(2));
  EXPECT_EQ(auxiliaries.coolant(), "coolant flood");
  EXPECT_EQ(auxiliaries.spindle(), "spindle clockwise 8000 rev/min");
}

TEST(Auxiliaries, WhatWasRefusedOrAnsweredToAnotherServiceIsNotDone) {
  Auxiliaries auxiliaries;
  auxiliaries.ask(asked(1, ActionKind::kSpindleClockwise, 8000));
  auxiliaries.answer(answered(1, 8));
  EXPECT_EQ(auxiliaries.spindle(), "");
  EXPECT_NE(auxiliaries.waits_for(), "");
  auxiliaries.answer(refused(1));
  EXPECT_EQ(auxiliaries.spindle(), "");
  EXPECT_EQ(auxiliaries.waits_for(), "");
}

TEST(Auxiliaries, NothingIsKnownToTurnBehindAFaultAndNothingWaitsInReady) {
  Auxiliaries auxiliaries;
  auxiliaries.ask(asked(1, ActionKind::kSpindleClockwise, 8000));
  auxiliaries.answer(answered(1));
  auxiliaries.ask(asked(2, ActionKind::kToolChange, 3));
  auxiliaries.follow(in_state(State::kHeld));
  EXPECT_EQ(auxiliaries.waits_for(), "change to tool 3");
  auxiliaries.follow(in_state(State::kReady));
  EXPECT_EQ(auxiliaries.waits_for(), "");
  EXPECT_NE(auxiliaries.spindle(), "");
  auxiliaries.follow(in_state(State::kFaultStop));
  EXPECT_EQ(auxiliaries.spindle(), "");
}

}  // namespace
}  // namespace meridian::panel
