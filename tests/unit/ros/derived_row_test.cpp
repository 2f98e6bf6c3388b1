// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/derived_row.hpp"

#include <gtest/gtest.h>

#include "support/machines.hpp"

namespace meridian::ros {
namespace {

class Derived : public testing::Test {
 protected:
  /// A row in which joint 0 stands at `q` mm.
  void add(std::uint64_t cycle, double q, std::uint16_t flags = kSetpointEnabled) {
    record::RecordingRow row;
    row.cycle = cycle;
    row.flags = flags;
    row.joints[0] = q;
    row.positions = limited_of(model_, row.joints);
    derived_.add(row);
  }
  [[nodiscard]] double share(std::size_t of) const { return derived_.shares()[0][of]; }

  MachineModel model_ = test::lai_machine();
  DerivedRow derived_{model_};
  const double period_ = 1e-9 * static_cast<double>(model_.cycle_ns);
};

TEST_F(Derived, TellsTheFeedOfTheTipBetweenNeighbours) {
  add(1, 0);
  EXPECT_EQ(derived_.feed_mm_per_s(), 0);
  add(2, 0.05);
  EXPECT_NEAR(derived_.feed_mm_per_s(), 0.05 / period_, 1e-9);
  EXPECT_NEAR(derived_.turn_rad_per_s(), 0, 1e-9);
  add(4, 0.10);
  EXPECT_EQ(derived_.feed_mm_per_s(), 0) << "a cycle is missing";
}

TEST_F(Derived, KeepsTheLargestShareOfEveryLimitUntilItIsForgotten) {
  const JointLimits& limits = model_.joints[0].limits;
  // q = 0, 0, 0, d: the first step has velocity, acceleration and jerk at once.
  const double d = 1e-6;
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) add(cycle, 0);
  EXPECT_EQ(share(0), 0);
  add(4, d);
  EXPECT_NEAR(share(0), d / period_ / limits.velocity, 1e-12);
  EXPECT_NEAR(share(1), d / period_ / period_ / limits.acceleration, 1e-9);
  EXPECT_NEAR(share(2), d / period_ / period_ / period_ / limits.jerk, 1e-6);
  add(5, d);
  add(6, d);
  EXPECT_NEAR(share(0), d / period_ / limits.velocity, 1e-12) << "the largest stays";
  derived_.forget_shares();
  for (std::uint64_t cycle = 7; cycle <= 9; ++cycle) add(cycle, d);
  EXPECT_EQ(share(0), 0);
  EXPECT_EQ(share(2), 0);
}

TEST_F(Derived, BreaksTheRowOfDifferencesWhereNobodyLeads) {
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) add(cycle, 0);
  add(4, 10, 0);
  EXPECT_EQ(share(0), 0) << "the drives were moved by hand";
  add(5, 10);
  EXPECT_EQ(share(0), 0);
  EXPECT_EQ(share(1), 0);
}

TEST_F(Derived, HoldsAFaultStopAgainstItsOwnLimits) {
  model_.joints[0].limits.fault_jerk = 2 * model_.joints[0].limits.jerk;
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) add(cycle, 0);
  add(4, 1e-6, kSetpointEnabled | kSetpointFaultStop);
  EXPECT_NEAR(share(2), 1e-6 / period_ / period_ / period_ / model_.joints[0].limits.fault_jerk,
              1e-6);
}

}  // namespace
}  // namespace meridian::ros
