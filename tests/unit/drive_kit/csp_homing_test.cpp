// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/csp_homing.hpp"

#include <gtest/gtest.h>

namespace meridian::drive {
namespace {

// Statuswords in operation enabled, mode 6: bits 10, 12 and 13 as CiA 402-2 has them.
constexpr std::uint16_t kSearching = 0x0237, kIdle = 0x0637, kMoves = 0x1237, kAttained = 0x1637,
                        kFailedMoving = 0x2237, kFailed = 0x2637;

[[nodiscard]] CspHoming asked() {
  CspHoming homing;
  homing.want(true);
  homing.see(kIdle, true);
  return homing;
}

TEST(CspHoming, StartsBehindTheModeAndEndsWithTheStatusword) {
  CspHoming homing;
  homing.want(true);
  EXPECT_EQ(homing.controlword_bits(), 0) << "not in mode 6 yet";
  homing.see(kIdle, false);
  EXPECT_EQ(homing.controlword_bits(), 0);
  homing.see(kIdle, true);
  EXPECT_EQ(homing.controlword_bits(), 0x10);
  homing.see(kSearching, true);
  EXPECT_EQ(homing.result(), HomingState::kSearching);
  homing.see(kMoves, true);
  EXPECT_EQ(homing.result(), HomingState::kSearching) << "found, and still moving";
  homing.see(kAttained, true);
  EXPECT_EQ(homing.result(), HomingState::kAttained);
  homing.want(false);
  EXPECT_EQ(homing.controlword_bits(), 0);
}

TEST(CspHoming, TheResultOfTheSearchBeforeDoesNotCount) {
  for (const std::uint16_t stale : {kAttained, kFailed}) {
    CspHoming homing = asked();
    homing.pass(0.001);
    homing.see(stale, true);
    EXPECT_EQ(homing.result(), HomingState::kSearching);
  }
}

TEST(CspHoming, AMethodWithoutMotionMayEndAtOnce) {
  CspHoming homing = asked();
  homing.pass(0.2);
  homing.see(kAttained, true);
  EXPECT_EQ(homing.result(), HomingState::kAttained);
}

TEST(CspHoming, ASearchMayFailMovingOrAtRest) {
  for (const std::uint16_t failed : {kFailedMoving, kFailed}) {
    CspHoming homing = asked();
    homing.see(kSearching, true);
    homing.see(failed, true);
    EXPECT_EQ(homing.result(), HomingState::kFailed);
  }
}

}  // namespace
}  // namespace meridian::drive
