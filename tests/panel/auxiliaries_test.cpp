// SPDX-License-Identifier: Apache-2.0
#include "service/panel/auxiliaries.hpp"

#include <gtest/gtest.h>

namespace meridian::panel {
namespace {

[[nodiscard]] dds::Action asked(std::uint64_t id, ActionKind kind, double value = 0) {
  dds::Action action;
  action.id = id;
  action.service_id = 7;
  action.kind = kind;
  action.value = value;
  return action;
}

[[nodiscard]] dds::ActionDone answered(std::uint64_t id, bool is_done, std::uint64_t service = 7) {
  dds::ActionDone done;
  done.id = id;
  done.service_id = service;
  done.is_done = is_done;
  return done;
}

[[nodiscard]] dds::Status in_state(State state) {
  dds::Status status;
  status.state = state;
  return status;
}

TEST(Auxiliaries, SpindleAndCoolantAreWhatWasDone) {
  Auxiliaries auxiliaries;
  auxiliaries.ask(asked(1, ActionKind::kSpindleClockwise, 8000));
  EXPECT_EQ(auxiliaries.waits_for(), "spindle clockwise 8000 rev/min");
  EXPECT_EQ(auxiliaries.spindle(), "") << "nobody has done it yet";
  auxiliaries.answer(answered(1, true));
  EXPECT_EQ(auxiliaries.waits_for(), "");
  EXPECT_EQ(auxiliaries.spindle(), "spindle clockwise 8000 rev/min");
  auxiliaries.ask(asked(2, ActionKind::kCoolantFlood));
  auxiliaries.answer(answered(2, true));
  EXPECT_EQ(auxiliaries.coolant(), "coolant flood");
  EXPECT_EQ(auxiliaries.spindle(), "spindle clockwise 8000 rev/min");
}

TEST(Auxiliaries, WhatWasRefusedOrAnsweredToAnotherServiceIsNotDone) {
  Auxiliaries auxiliaries;
  auxiliaries.ask(asked(1, ActionKind::kSpindleClockwise, 8000));
  auxiliaries.answer(answered(1, true, 8));
  EXPECT_EQ(auxiliaries.spindle(), "");
  EXPECT_NE(auxiliaries.waits_for(), "");
  auxiliaries.answer(answered(1, false));
  EXPECT_EQ(auxiliaries.spindle(), "");
  EXPECT_EQ(auxiliaries.waits_for(), "");
}

TEST(Auxiliaries, NothingIsKnownToTurnBehindAFaultAndNothingWaitsInReady) {
  Auxiliaries auxiliaries;
  auxiliaries.ask(asked(1, ActionKind::kSpindleClockwise, 8000));
  auxiliaries.answer(answered(1, true));
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
