// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/end_watch.hpp"

#include <gtest/gtest.h>

namespace meridian::stream {
namespace {

class EndWatchTest : public testing::Test {
 protected:
  void status(std::uint64_t cycle, State state) {
    dds::Status status;
    status.cycle = cycle;
    status.state = state;
    watch_.see(status);
  }
  void move(std::uint64_t cycle) {
    Setpoint setpoint;
    setpoint.cycle = cycle;
    setpoint.flags = kSetpointMoving;
    watch_.see(setpoint);
  }

  EndWatch watch_;
};

TEST_F(EndWatchTest, EndsWithTheProgramThatTheStatusShowed) {
  status(10, State::kLoaded);
  status(50, State::kRunning);
  EXPECT_FALSE(watch_.is_over());
  status(90, State::kReady);
  EXPECT_TRUE(watch_.is_over());
}

TEST_F(EndWatchTest, EndsWithOneThatNoStatusShowed) {
  status(10, State::kReady);
  move(30);
  EXPECT_FALSE(watch_.is_over());
  status(30, State::kReady);
  EXPECT_FALSE(watch_.is_over()) << "it may still be moving";
  status(50, State::kReady);
  EXPECT_TRUE(watch_.is_over());
}

TEST_F(EndWatchTest, TakesWhatAHandOrAHomingMovedForNoProgram) {
  for (const State by_hand : {State::kJogging, State::kHoming}) {
    move(20);
    status(20, by_hand);
    move(30);
    status(31, State::kAborting);  // it brakes
    move(32);
    status(40, State::kReady);
    move(39);  // seen behind the status
    status(60, State::kReady);
    EXPECT_FALSE(watch_.is_over());
  }
  move(70);
  status(80, State::kReady);
  EXPECT_TRUE(watch_.is_over()) << "and this one was";
}

}  // namespace
}  // namespace meridian::stream
