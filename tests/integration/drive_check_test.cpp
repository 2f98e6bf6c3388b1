// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "integration/plant.hpp"

namespace meridian::test {
namespace {

constexpr milliseconds kLong{80'000};

/// `meridian drives --check` as a person uses it.
class CheckOfDrives : public testing::Test {
 protected:
  Process check() {
    return Process(
        {"meridian", "drives", "--check", "--machine", plant.machine(), "--domain", plant.domain()},
        plant.folder() / "check.log");
  }
  Plant plant;
};

TEST_F(CheckOfDrives, SimulatedDrivesBreakNoRuleOnTheWire) {
  plant.start_drives();
  Process checked = check();
  EXPECT_EQ(checked.wait(kLong), 0) << checked.said();
  EXPECT_NE(checked.said().find("PASS: "), std::string::npos) << checked.said();
}

TEST_F(CheckOfDrives, ADriveThatDoesNotMoveIsNamedWithTheRuleAndItsPage) {
  plant.start_drives({"--inject", "blocked@0.01:b3"});
  Process checked = check();
  EXPECT_EQ(checked.wait(kLong), 1) << checked.said();
  EXPECT_NE(checked.said().find("BROKEN follows: "), std::string::npos) << checked.said();
  EXPECT_NE(checked.said().find("(docs/topics.md, "), std::string::npos) << checked.said();
}

TEST_F(CheckOfDrives, IsNotBegunWhereAServiceIsThereOrNobodyReports) {
  Process lonely = check();
  EXPECT_EQ(lonely.wait(kLong), 5) << lonely.said();
  plant.start_service();
  (void)plant.status();
  Process beside = check();
  EXPECT_EQ(beside.wait(kLong), 4) << beside.said();
  EXPECT_NE(beside.said().find("end it first"), std::string::npos) << beside.said();
}

}  // namespace
}  // namespace meridian::test
