// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

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
  /// Again where the host, which other tests share, was too busy for a rule: as its last line says.
  std::pair<std::optional<int>, std::string> check_on_a_quiet_host() {
    constexpr int kTries = 3;
    for (int n = 1;; ++n) {
      std::filesystem::remove(plant.folder() / "check.log");  // a process adds to it
      Process checked = check();
      const std::optional<int> code = checked.wait(kLong);
      const std::string said = checked.said();
      const bool was_busy = said.find("this host was busy, try again") != std::string::npos;
      if (!was_busy || n == kTries) return {code, said};
    }
  }
  Plant plant;
};

TEST_F(CheckOfDrives, SimulatedDrivesBreakNoRuleOnTheWire) {
  plant.start_drives();
  const auto [code, said] = check_on_a_quiet_host();
  EXPECT_EQ(code, 0) << said;
  EXPECT_NE(said.find("PASS: "), std::string::npos) << said;
}

TEST_F(CheckOfDrives, TheExampleOfTheLibraryBreaksNoRuleOnTheWire) {
  Process example({"my_drives", plant.machine(), plant.domain()}, plant.folder() / "my_drives.log");
  const auto [code, said] = check_on_a_quiet_host();
  EXPECT_EQ(code, 0) << said;
  EXPECT_NE(said.find("PASS: 43 rules, 0 broken"), std::string::npos) << said;
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
