// SPDX-License-Identifier: Apache-2.0

/// Instructions per call, counted by callgrind: the same on every host, however busy. Limits are in
/// deploy/budgets.toml.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/host/probe/budgets.hpp"
#include "service/host/process/programs.hpp"

namespace meridian {
namespace {

/// `count_instructions WORKLOAD COUNT` under callgrind, which takes `options`.
[[nodiscard]] std::string counting(const std::string& options, const std::string& workload,
                                   int count) {
  // The C library picks its functions by the host's CPU; without these it is the same everywhere.
  return "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-ERMS LD_BIND_NOW=1 "
         "valgrind --tool=callgrind " +
         options + " '" MERIDIAN_COUNTED_PROGRAM "' " + workload + " " + std::to_string(count) +
         " 2>&1";
}

/// Instructions of the whole run, or nothing where it fails.
std::optional<std::int64_t> count_run(const std::string& workload, int count) {
  const std::string command = counting("--callgrind-out-file=/dev/null", workload, count);
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

/// Instructions of each call of a workload that says where one begins; nothing where the run fails.
std::vector<std::int64_t> count_calls(const std::string& workload, int count) {
  const process::ScratchFolder folder;
  const std::string file = (folder.path() / "calls").string();
  const std::string options = "--callgrind-out-file='" + file +
                              "' --combine-dumps=yes --dump-before='*begin_counted_call*'";
  std::vector<std::int64_t> parts;
  if (std::system((counting(options, workload, count) + " > /dev/null").c_str()) != 0) return parts;
  std::ifstream lines(file);
  constexpr std::string_view kWord = "summary: ";
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kWord)) parts.push_back(std::atoll(line.c_str() + kWord.size()));
  }
  // Before the first call, and after the last, is what does not count.
  if (parts.size() != static_cast<std::size_t>(count) + 2) return {};
  return {parts.begin() + 1, parts.end() - 1};
}

/// Why nothing can be counted here; empty: it can.
[[nodiscard]] const char* why_not_counted() {
  if (std::string_view(MERIDIAN_BUILD_TYPE) != "Release" ||
      !std::string_view(MERIDIAN_SANITIZE).empty()) {
    return "instruction counts are of the Release build, without sanitizers";
  }
  if (std::system("valgrind --version > /dev/null 2>&1") != 0) {
    return "no valgrind on this host: apt-get install valgrind";
  }
  return "";
}

/// Fails where `figure` is more than the budget "instructions_WORKLOAD", or far less.
void expect_within(const std::string& workload, double figure) {
  const probe::Budget budget = probe::load_budget("instructions_" + workload);
  std::printf("%s: %s %.1f instructions; %s\n", workload.c_str(), budget.statistic.c_str(), figure,
              probe::to_text(budget).c_str());
  EXPECT_LE(figure, budget.allowed());
  EXPECT_GE(figure, 0.5 * budget.allowed())
      << "far below the limit: lower it, or does the workload still do its work?";
}

/// Fails where one call takes more instructions on the average than its budget.
void expect_within_budget(const std::string& workload, int calls) {
  if (const char* const why = why_not_counted(); *why != '\0') GTEST_SKIP() << why;
  const auto few = count_run(workload, calls);
  const auto many = count_run(workload, 2 * calls);
  ASSERT_TRUE(few && many) << "count_instructions " << workload << " failed under callgrind";
  expect_within(workload, static_cast<double>(*many - *few) / calls);
}

/// The same of the call that takes the most.
void expect_max_within_budget(const std::string& workload, int calls) {
  if (const char* const why = why_not_counted(); *why != '\0') GTEST_SKIP() << why;
  const auto counts = count_calls(workload, calls);
  ASSERT_FALSE(counts.empty()) << "count_instructions " << workload << " failed under callgrind";
  expect_within(workload, static_cast<double>(*std::max_element(counts.begin(), counts.end())));
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
TEST(InstructionGate, TheDearestCycleOfASmoothCutOverWindows) {
  expect_max_within_budget("cycle_over_windows", 900);
}
TEST(InstructionGate, SetpointOnASpline) { expect_within_budget("setpoint_spline", 20000); }
TEST(InstructionGate, SetpointBesideThePole) { expect_within_budget("setpoint_pole", 20000); }
TEST(InstructionGate, MonitoringBesideACycle) { expect_within_budget("monitoring", 8000); }
TEST(InstructionGate, MonitoringOfEverythingBesideACycle) {
  expect_within_budget("monitoring_all", 8000);
}
TEST(InstructionGate, TracingThatIsOff) { expect_within_budget("trace_off", 8000); }
TEST(InstructionGate, Planner) { expect_within_budget("planner", 100); }
TEST(InstructionGate, SmoothPlannerPerBlock) { expect_within_budget("smooth_block", 55); }
TEST(InstructionGate, SmoothPlannerPerDenseBlock) {
  expect_within_budget("smooth_dense_block", 8000);
}
TEST(InstructionGate, SmoothPlannerPerHostileWindow) { expect_within_budget("smooth_window", 10); }

}  // namespace
}  // namespace meridian
