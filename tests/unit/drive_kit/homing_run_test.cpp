// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/homing_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

#include "service/drives/kit/csp/following_axis.hpp"
#include "unit/drive_kit/scripted_hardware.hpp"

namespace meridian::drive {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr std::uint16_t kHomingBits = 0x3400;

HomingSpec by_index(double distance = 50) {
  HomingSpec homing;
  homing.method = HomingMethod::kByIndex;
  homing.is_referenced = false;
  homing.index_position = 250;
  homing.search_velocity = -20;
  homing.search_distance = distance;
  return homing;
}
HomingSpec by(HomingMethod method) {
  HomingSpec homing;
  homing.method = method;
  homing.is_referenced = false;
  return homing;
}

/// An axis in homing mode and operation enabled; setpoints come all the time.
class Homed {
 public:
  explicit Homed(const HomingSpec& homing) : axis_(spec(), homing, 0) {
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
      axis_.take_controlword(word, dds::kHomingMode);
    }
    period();
  }
  static JointSpec spec() {
    JointSpec joint;
    joint.limits.velocity = 300;
    joint.limits.following_error = 5;
    joint.limits.fault_acceleration = 1000;
    return joint;
  }
  void ask(bool is_start) { axis_.take_controlword(is_start ? 0x1F : 0x0F, dds::kHomingMode); }
  void period() {
    motors_.write(0, axis_.lead({.is_new = true, .is_enabled = true, .elapsed_s = kPeriod_s},
                                kPeriod_s, 0, motors_));
    axis_.see(motors_.read(0), kPeriod_s);
  }
  void periods(int count) {
    for (int n = 0; n < count; ++n) period();
  }
  [[nodiscard]] std::uint16_t bits() const { return axis_.statusword() & kHomingBits; }

  test::ScriptedHardware motors_;
  FollowingAxis axis_;
};

TEST(Homing, AnAbsoluteEncoderHasItsReferenceAtOnceAndNothingMoves) {
  Homed homed(by(HomingMethod::kNone));
  EXPECT_FALSE(homed.axis_.is_referenced());
  homed.ask(true);
  homed.period();
  EXPECT_EQ(homed.bits(), kStatusTargetReached | kStatusHomingAttained);
  EXPECT_TRUE(homed.axis_.is_referenced());
  EXPECT_EQ(homed.motors_.outputs[0].position, 0);
}

TEST(Homing, TheDriveSearchesByItselfAndTheLibraryLeadsNothing) {
  Homed homed(by(HomingMethod::kByDrive));
  homed.ask(true);
  homed.period();
  EXPECT_TRUE(homed.motors_.outputs[0].is_homing);
  EXPECT_TRUE(homed.motors_.last_view.is_begin);
  for (int n = 1; n < 100; ++n) {
    homed.motors_.readings[0].position = -0.5 * n;
    homed.period();
    EXPECT_FALSE(homed.motors_.last_view.is_begin);
  }
  EXPECT_EQ(homed.axis_.error(), kErrorNone) << "no following error against what it does itself";
  EXPECT_EQ(homed.bits(), 0);
  homed.motors_.next_step.state = HomingState::kAttained;
  homed.period();
  EXPECT_TRUE(homed.axis_.is_referenced());
  homed.period();
  EXPECT_FALSE(homed.motors_.outputs[0].is_homing);
}

TEST(Homing, ADriveThatFindsNothingReportsTheHomingError) {
  Homed homed(by(HomingMethod::kByDrive));
  homed.motors_.next_step.state = HomingState::kFailed;
  homed.ask(true);
  homed.period();
  EXPECT_EQ(homed.bits(), kStatusTargetReached | kStatusHomingError);
  EXPECT_FALSE(homed.axis_.is_referenced());
}

TEST(Homing, TheCallbackLeadsTheAxisAndNamesItsPlace) {
  Homed homed(by(HomingMethod::kByCallback));
  homed.motors_.next_step.target = 0.1;
  homed.ask(true);
  homed.periods(10);
  EXPECT_NEAR(homed.motors_.outputs[0].position, 1.0, 1e-12);
  homed.motors_.next_step = {HomingState::kAttained, 0, 0, 99};
  homed.motors_.is_stuck = true;
  homed.motors_.readings[0].position = 100;
  homed.period();
  EXPECT_NEAR(homed.axis_.position(), 100, 1e-12);
  EXPECT_NEAR(homed.axis_.following_error(), 0, 1e-9);
  EXPECT_TRUE(homed.axis_.is_referenced());
}

TEST(Homing, ACallbackThatLeadsFasterThanTheLimitIsRefused) {
  Homed homed(by(HomingMethod::kByCallback));
  homed.motors_.next_step.target = 0.4;  // 0.3 mm is what it can do in a period
  homed.ask(true);
  homed.period();
  EXPECT_EQ(homed.axis_.error(), kErrorSetpointStep);
  EXPECT_EQ(homed.motors_.outputs[0].position, 0);
}

TEST(Homing, TheIndexPulseNamesThePlaceWhereItCame) {
  Homed homed(by_index());
  homed.ask(true);
  double steepest = 0, fastest = 0, before = 0;
  for (int n = 0; n < 2000 && homed.bits() == 0; ++n) {
    Reading& reading = homed.motors_.readings[0];
    reading.is_index = before > -10 && reading.position <= -10;
    reading.index_position = -10.0;
    before = reading.position;
    const double velocity = homed.motors_.outputs[0].velocity;
    homed.period();
    steepest = std::max(steepest, std::abs(homed.motors_.outputs[0].velocity - velocity));
    fastest = std::max(fastest, std::abs(homed.motors_.outputs[0].velocity));
  }
  EXPECT_EQ(homed.bits(), kStatusTargetReached | kStatusHomingAttained);
  EXPECT_LE(steepest, 1000 * kPeriod_s * (1 + 1e-9)) << "up and down by the ramp";
  EXPECT_NEAR(fastest, 20, 1e-9);
  const double raw = homed.motors_.readings[0].position;
  EXPECT_NEAR(raw, -10.2, 0.05) << "20 mm/s at 1000 mm/s2: 0.2 mm behind the pulse";
  homed.period();
  EXPECT_NEAR(homed.axis_.position(), 250 + (raw + 10), 1e-9);
  // From now on setpoints are in the new names, the motor keeps its own.
  homed.axis_.take_controlword(0x0F, dds::kCyclicPositionMode);
  homed.motors_.write(0, homed.axis_.lead({.is_new = true,
                                           .is_enabled = true,
                                           .position = homed.axis_.position(),
                                           .elapsed_s = kPeriod_s},
                                          kPeriod_s, 0, homed.motors_));
  EXPECT_NEAR(homed.motors_.outputs[0].position, raw, 1e-9);
}

TEST(Homing, ASearchForAPulseThatNeverComesEndsAfterItsDistance) {
  Homed homed(by_index(5));
  homed.ask(true);
  homed.periods(600);
  EXPECT_EQ(homed.bits(), kStatusTargetReached | kStatusHomingError);
  EXPECT_NEAR(homed.motors_.readings[0].position, -5.2, 0.05);
  EXPECT_FALSE(homed.axis_.is_referenced());
}

TEST(Homing, APulseFromBeforeTheSearchDoesNotCount) {
  Homed homed(by_index(5));
  homed.motors_.readings[0].is_index = true;
  homed.period();
  homed.ask(true);
  homed.motors_.readings[0].is_index = false;
  homed.periods(600);
  EXPECT_EQ(homed.bits(), kStatusTargetReached | kStatusHomingError);
}

TEST(Homing, ASearchThatIsInterruptedRampsDownAndIsBegunAnewByTheNextEdge) {
  Homed homed(by_index());
  homed.ask(true);
  homed.periods(100);
  homed.ask(false);
  const double at = homed.motors_.readings[0].position;
  homed.periods(100);
  EXPECT_NEAR(homed.motors_.readings[0].position, at - 0.2, 0.03);
  EXPECT_EQ(homed.bits(), kStatusTargetReached);
  homed.ask(true);
  homed.periods(10);
  EXPECT_EQ(homed.bits(), 0);
}

TEST(Homing, AFaultWhileTheDriveSearchesEndsItsSearch) {
  Homed homed(by(HomingMethod::kByDrive));
  homed.ask(true);
  homed.period();
  homed.motors_.readings[0].error = 0x2310;
  homed.periods(3);
  EXPECT_FALSE(homed.motors_.outputs[0].is_homing);
  EXPECT_FALSE(homed.motors_.outputs[0].is_on);
}

}  // namespace
}  // namespace meridian::drive
