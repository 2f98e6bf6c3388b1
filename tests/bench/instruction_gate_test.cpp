// SPDX-License-Identifier: Apache-2.0

/// Instructions per call, counted by callgrind: the same on every host, however busy. Limits are in
/// deploy/budgets.toml.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "service/probe/budgets.hpp"

namespace meridian {
namespace {

/// Instructions of `count_instructions WORKLOAD COUNT`, or nothing where the run fails.
std::optional<std::int64_t> count_run(const std::string& workload, int count) {
  // The C library picks its functions by the host's CPU; without these it is the same everywhere.
  const std::string command =
      "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-ERMS valgrind --tool=callgrind "
      "--callgrind-out-file=/dev/null '" MERIDIAN_COUNTED_PROGRAM "' " +
      workload + " " + std::to_string(count) + " 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    return std::nullopt;
  }
  std::optional<std::int64_t> collected;
  std::array<char, 512> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) {
    const std::string_view text = line.data();
    constexpr std::string_view kWord = "Collected :";
    if (const auto at = text.find(kWord); at != std::string_view::npos) {
      collected = std::atoll(line.data() + at + kWord.size());
    }
  }
  return pclose(pipe) == 0 ? collected : std::nullopt;
}

/// Fails where one call takes more instructions than the budget "instructions_WORKLOAD".
void expect_within_budget(const std::string& workload, int calls) {
  if (std::string_view(MERIDIAN_BUILD_TYPE) != "Release" ||
      !std::string_view(MERIDIAN_SANITIZE).empty()) {
    GTEST_SKIP() << "instruction counts are of the Release build, without sanitizers";
  }
  if (std::system("valgrind --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no valgrind on this host: apt-get install valgrind";
  }
  const auto few = count_run(workload, calls);
  const auto many = count_run(workload, 2 * calls);
  ASSERT_TRUE(few && many) << "count_instructions " << workload << " failed under callgrind";
  const double per_call = static_cast<double>(*many - *few) / calls;
  const probe::Budget budget = probe::load_budget("instructions_" + workload);
  std::printf("%s: %.1f instructions per call, %d calls; %s\n", workload.c_str(), per_call, calls,
              probe::to_text(budget).c_str());
  EXPECT_LE(per_call, budget.allowed());
  EXPECT_GE(per_call, 0.5 * budget.allowed())
      << "far below the limit: lower it, or does the workload still do its work?";
}

TEST(InstructionGate, InverseKinematics) { expect_within_budget("inverse_kinematics", 4096); }
TEST(InstructionGate, InverseKinematicsOfAnyChain) {
  expect_within_budget("inverse_kinematics_chain", 4096);
}
TEST(InstructionGate, InverseKinematicsOfRobot5R) {
  expect_within_budget("inverse_kinematics_robot_5r", 4096);
}
TEST(InstructionGate, InverseKinematicsOfRobot6R) {
  expect_within_budget("inverse_kinematics_robot_6r", 4096);
}
TEST(InstructionGate, Cycle) { expect_within_budget("cycle", 8000); }
TEST(InstructionGate, CycleThatSeeksTheEndOfItsBlock) {
  expect_within_budget("cycle_single_block", 1000);
}
TEST(InstructionGate, SetpointOnASpline) { expect_within_budget("setpoint_spline", 20000); }
TEST(InstructionGate, SetpointBesideThePole) { expect_within_budget("setpoint_pole", 20000); }
TEST(InstructionGate, TracingThatIsOff) { expect_within_budget("trace_off", 8000); }
TEST(InstructionGate, Planner) { expect_within_budget("planner", 100); }
TEST(InstructionGate, SmoothPlannerPerBlock) { expect_within_budget("smooth_block", 55); }
TEST(InstructionGate, SmoothPlannerPerDenseBlock) {
  expect_within_budget("smooth_dense_block", 8000);
}
TEST(InstructionGate, SmoothPlannerPerHostileWindow) { expect_within_budget("smooth_window", 10); }

}  // namespace
}  // namespace meridian
