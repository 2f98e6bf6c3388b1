// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/setpoint_check.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace meridian::drive {
namespace {

constexpr double kPeriod_s = 1e-3;

/// 300 mm/s, so 0.3 mm in a period; 6000 mm/s² in a FaultStop: 37.5 mm run out, and 30 bridged.
JointSpec some_drive() {
  JointSpec drive;
  drive.limits.travel_min = -600;
  drive.limits.travel_max = 600;
  drive.limits.velocity = 300;
  drive.limits.fault_acceleration = 6000;
  drive.limits.following_error = 5;
  return drive;
}

CheckedSetpoint following(double from, double to, double velocity = 0, int periods = 1) {
  return {.position = to,
          .velocity = velocity,
          .has_begun = true,
          .from = from,
          .elapsed_s = periods * kPeriod_s};
}
CheckedSetpoint beginning(double stands, double to) { return {.position = to, .from = stands}; }

struct Row {
  const char* what;
  CheckedSetpoint asked;
  std::uint16_t error;
};

TEST(SetpointCheck, RefusesByThisTable) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto in_fault_stop = [](CheckedSetpoint asked) {
    asked.is_fault_stop = true;
    return asked;
  };
  const auto unreferenced = [](CheckedSetpoint asked) {
    asked.is_referenced = false;
    return asked;
  };
  const std::vector<Row> table{
      {"it stands", following(10, 10), kErrorNone},
      {"at full speed", following(10, 10.3, 300), kErrorNone},
      {"over three lost periods", following(10, 11.2, 300, 4), kErrorNone},
      {"no number", following(10, kNaN), kErrorSetpointNoNumber},
      {"a velocity that is none", following(10, 10, kNaN), kErrorSetpointNoNumber},
      {"sums overflow", following(10, 1e308), kErrorSetpointNoNumber},
      {"too fast", following(10, 10.1, 307), kErrorSetpointVelocity},
      {"too fast backwards", following(10, 10.1, -3500), kErrorSetpointVelocity},
      {"a jump", following(10, 10.4, 100), kErrorSetpointStep},
      {"a jump back", following(10, 9.6, 100), kErrorSetpointStep},
      {"a jump over lost periods", following(10, 11.5, 100, 4), kErrorSetpointStep},
      {"to the end of travel", following(599.8, 600, 1), kErrorNone},
      {"out of travel", following(599.9, 600.1, 1), kErrorSetpointTravel},
      {"out of travel below", following(-599.9, -600.1, 1), kErrorSetpointTravel},
      {"farther out", following(601, 601.1, 1), kErrorSetpointTravel},
      {"outside, and stands", following(601, 601), kErrorNone},
      {"outside, and comes back", following(601, 600.9, -1), kErrorNone},
      {"runs out in a FaultStop", in_fault_stop(following(600, 600.2, 200)), kErrorNone},
      {"farther than it runs", in_fault_stop(following(668, 668.2, 200)), kErrorSetpointTravel},
      {"without a reference", unreferenced(following(601, 601.1, 1)), kErrorNone},
      {"begins where it stands", beginning(10, 10.1), kErrorNone},
      {"begins somewhere else", beginning(10, 13), kErrorSetpointBegin},
  };
  for (const Row& row : table)
    EXPECT_EQ(check_setpoint(some_drive(), row.asked), row.error) << row.what;
}

TEST(SetpointCheck, KnowsNoTravelOfAnEndlessJointAndNoLimitThatIsNotGiven) {
  JointSpec endless = some_drive();
  endless.is_endless = true;
  EXPECT_EQ(check_setpoint(endless, following(4000, 4000.1, 1)), kErrorNone);
  EXPECT_EQ(check_setpoint(JointSpec{}, following(0, 4000, 5000)), kErrorNone);
  EXPECT_EQ(check_setpoint(JointSpec{}, beginning(0, 4000)), kErrorNone);
}

}  // namespace
}  // namespace meridian::drive
