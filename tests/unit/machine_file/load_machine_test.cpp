// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "meridian/machine_file.hpp"

namespace meridian {
namespace {

TEST(LoadMachine, GivesTheModelOfAMachineFile) {
  const auto machine = load_machine(std::string(MERIDIAN_SOURCE_DIR) + "/deploy/machines/lai.toml");
  ASSERT_TRUE(machine.has_value()) << machine.error();
  EXPECT_EQ(machine->joint_count, 5);
}

TEST(LoadMachine, NamesTheFileThatIsNotThere) {
  const auto machine = load_machine("/nowhere/absent.toml");
  ASSERT_FALSE(machine.has_value());
  EXPECT_NE(machine.error().find("absent.toml"), std::string::npos) << machine.error();
}

}  // namespace
}  // namespace meridian
