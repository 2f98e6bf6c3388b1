// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/awaited_action.hpp"

#include <gtest/gtest.h>

#include "panel/action_samples.hpp"

namespace meridian::panel {
namespace {

TEST(AwaitedAction, IsOverWhenItWasAnsweredByWhomeverItMayBe) {
  AwaitedAction awaited;
  awaited.ask(asked(1));
  EXPECT_FALSE(awaited.answer(answered(2)));
  EXPECT_FALSE(awaited.answer(answered(1, 8))) << "of another service";
  ASSERT_TRUE(awaited.now());
  EXPECT_EQ(awaited.answer(answered(1))->id, 1U);
  EXPECT_FALSE(awaited.now());
  EXPECT_FALSE(awaited.answer(answered(1)));
}

TEST(AwaitedAction, ThatIsAskedForAgainTakesThePlaceOfTheOneBefore) {
  AwaitedAction awaited;
  awaited.ask(asked(1));
  awaited.ask(asked(2));
  EXPECT_TRUE(awaited.answer(answered(2)));
  EXPECT_FALSE(awaited.now()) << "the first timed out";
}

TEST(AwaitedAction, EndsWithItsProgramAndWithItsService) {
  for (const State state : {State::kOff, State::kReady, State::kFault}) {
    AwaitedAction awaited;
    awaited.ask(asked(1));
    awaited.follow(in_state(State::kRunning));
    awaited.follow(in_state(State::kHeld));
    EXPECT_TRUE(awaited.now());
    awaited.follow(in_state(state));
    EXPECT_FALSE(awaited.now());
  }
  AwaitedAction awaited;
  awaited.ask(asked(1));
  awaited.follow(in_state(State::kRunning, 8));
  EXPECT_FALSE(awaited.now());
}

TEST(AwaitedAction, AProgramStopEndsWhereTheMachineGoesOn) {
  AwaitedAction awaited;
  awaited.ask(asked(1, ActionKind::kStop));
  awaited.follow(in_state(State::kRunning));
  EXPECT_TRUE(awaited.now()) << "it brakes yet";
  awaited.follow(in_state(State::kHeld));
  EXPECT_TRUE(awaited.now());
  awaited.follow(in_state(State::kRunning));
  EXPECT_FALSE(awaited.now());
  awaited.ask(asked(2));
  awaited.follow(in_state(State::kHeld));
  awaited.follow(in_state(State::kRunning));
  EXPECT_TRUE(awaited.now()) << "a tool change is waited for, whoever resumes";
}

}  // namespace
}  // namespace meridian::panel
