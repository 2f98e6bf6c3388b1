// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/position_window.hpp"

#include <gtest/gtest.h>

#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

Finding at(PositionWindow& window, double position, Mode mode, std::uint32_t known_mask = 1) {
  Inputs in;
  in.has_report = true;
  in.is_guard_open = mode == Mode::kSetUp || mode == Mode::kStandstill;
  in.known_mask = known_mask;
  in.measured[0] = position;
  return window.check(test::two_axes(), in, mode).finding;
}

TEST(PositionWindow, FindsAnAxisThatLeavesTheWindowOfItsMode) {
  PositionWindow automatic, set_up;
  EXPECT_EQ(at(automatic, 0, Mode::kAutomatic), Finding::kNone);
  EXPECT_EQ(at(automatic, 100.4, Mode::kAutomatic), Finding::kNone) << "its margin";
  EXPECT_EQ(at(automatic, 100.6, Mode::kAutomatic), Finding::kPositionWindow);
  EXPECT_EQ(at(set_up, 0, Mode::kSetUp), Finding::kNone);
  EXPECT_EQ(at(set_up, -10.6, Mode::kSetUp), Finding::kPositionWindow);
}

TEST(PositionWindow, LetsAnAxisComeBackThatWasOutside) {
  PositionWindow window;
  EXPECT_EQ(at(window, 120, Mode::kAutomatic), Finding::kNone) << "it stood there";
  EXPECT_EQ(at(window, 110, Mode::kAutomatic), Finding::kNone) << "it comes back";
  EXPECT_EQ(at(window, 120, Mode::kAutomatic), Finding::kPositionWindow) << "and out again";
}

TEST(PositionWindow, IsThatOfSetUpOnceTheGuardIsOpen) {
  PositionWindow window;
  EXPECT_EQ(at(window, 50, Mode::kAutomatic), Finding::kNone);
  EXPECT_EQ(at(window, 50, Mode::kSetUp), Finding::kNone) << "it stood there";
  EXPECT_EQ(at(window, 51, Mode::kSetUp), Finding::kPositionWindow);
}

TEST(PositionWindow, IsNotLeftStepByStepOfManyJogs) {
  PositionWindow window;
  double position = 10;  // the edge of the set-up window; its margin is 0.5
  Finding found = Finding::kNone;
  for (int jog = 0; jog < 4 && found == Finding::kNone; ++jog) {
    EXPECT_EQ(at(window, position, Mode::kStandstill), Finding::kNone);
    position += 0.3;
    found = at(window, position, Mode::kSetUp);
  }
  EXPECT_EQ(found, Finding::kPositionWindow);
  EXPECT_LT(position, 11);
}

TEST(PositionWindow, OfSetUpBeginsAnewWithTheGuard) {
  PositionWindow window;
  EXPECT_EQ(at(window, 0, Mode::kSetUp), Finding::kNone);
  EXPECT_EQ(at(window, 0, Mode::kAutomatic), Finding::kNone) << "it is shut";
  EXPECT_EQ(at(window, 50, Mode::kAutomatic), Finding::kNone);
  EXPECT_EQ(at(window, 50, Mode::kSetUp), Finding::kNone) << "it stood there when it opened";
}

TEST(PositionWindow, SaysNothingOfAnAxisThatDoesNotKnowWhereItIs) {
  PositionWindow window;
  EXPECT_EQ(at(window, 0, Mode::kAutomatic, 0), Finding::kNone);
  EXPECT_EQ(at(window, 500, Mode::kAutomatic, 0), Finding::kNone);
  EXPECT_EQ(at(window, 600, Mode::kOff), Finding::kNone);
}

}  // namespace
}  // namespace meridian::monitoring
