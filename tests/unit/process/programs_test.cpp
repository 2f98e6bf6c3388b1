// SPDX-License-Identifier: Apache-2.0
#include "service/host/process/programs.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

namespace meridian::process {
namespace {

TEST(Programs, AreFoundBesideTheRunningOne) {
  EXPECT_EQ(program_beside("unit_process").filename(), "unit_process");
  EXPECT_THROW((void)program_beside("no_such_program"), std::runtime_error);
}

TEST(Programs, FindWhatIsShippedAboveThem) {
  EXPECT_TRUE(std::filesystem::exists(shipped_file("machines/lai.toml")));
  EXPECT_THROW((void)shipped_file("no_such_file.toml"), std::runtime_error);
}

TEST(Programs, LeaveNothingInAScratchFolder) {
  std::filesystem::path path;
  {
    const ScratchFolder folder;
    path = folder.path();
    std::ofstream(path / "file") << "text";
    EXPECT_TRUE(std::filesystem::exists(path / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace meridian::process
