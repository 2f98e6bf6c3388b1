// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/positions_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::config {
namespace {

/// The shipped Lai machine with `more` behind it.
[[nodiscard]] std::string machine_with(const std::string& more) {
  std::ifstream file(std::string(MERIDIAN_SOURCE_DIR) + "/deploy/machines/lai.toml");
  return std::string{std::istreambuf_iterator<char>(file), {}} + more;
}

[[nodiscard]] std::vector<NamedPosition> positions_of(const std::string& text) {
  return parse_positions(text, "lai");
}

[[nodiscard]] std::string refusal_of(const std::string& more) {
  try {
    (void)parse_machine(machine_with(more), "lai");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

constexpr const char* kChange =
    "\n[[position]]\nname = \"change\"\njoints = [10, -20, 30, 180, -5]\n";

TEST(Positions, BeginWithHome) {
  const auto positions = positions_of(machine_with(""));
  ASSERT_EQ(positions.size(), 1U);
  EXPECT_EQ(positions[0].name, "home");
}

TEST(Positions, AreJointsInMachineOrder) {
  const auto positions = positions_of(machine_with(kChange));
  ASSERT_EQ(positions.size(), 2U);
  EXPECT_EQ(positions[1].name, "change");
  EXPECT_EQ(positions[1].joints,
            (JointVector{10, -20, 30, units::rad_from_deg(180), units::rad_from_deg(-5), 0}));
}

TEST(Positions, OutsideOfTravelAreRefusedByTheJoint) {
  const std::string far = "\n[[position]]\nname = \"far\"\njoints = [0, 0, 5000, 0, 0]\n";
  EXPECT_NE(refusal_of(far).find("travel of b4"), std::string::npos) << refusal_of(far);
}

TEST(Positions, NeedNamesOfTheirOwnAndEveryJoint) {
  const std::string home = "\n[[position]]\nname = \"home\"\njoints = [0, 0, 0, 0, 0]\n";
  EXPECT_NE(refusal_of(home).find("a name of its own"), std::string::npos) << refusal_of(home);
  EXPECT_NE(refusal_of(std::string(kChange) + kChange), "");
  EXPECT_NE(refusal_of("\n[[position]]\nname = \"few\"\njoints = [0, 0, 0]\n"), "");
  EXPECT_NE(refusal_of("\n[[position]]\njoints = [0, 0, 0, 0, 0]\n"), "");
  EXPECT_EQ(refusal_of(kChange), "");
}

}  // namespace
}  // namespace meridian::config
