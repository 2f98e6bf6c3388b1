// SPDX-License-Identifier: Apache-2.0

/// Every gate of CI that holds a budget goes red where its budget is broken: the gate's own program
/// runs against a table in which that one row cannot be kept. Those that take a moment always, all
/// of them where MERIDIAN_BREAK_GATES is set (docs/testing.md).

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "service/host/probe/budgets.hpp"
#include "service/host/process/programs.hpp"
#include "support/command_output.hpp"
#include "support/text_file.hpp"

namespace meridian {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTable = MERIDIAN_SOURCE_DIR "/deploy/budgets.toml";

struct Gate {
  const char *budget, *program, *filter;
  bool is_quick = false;
};

std::ostream& operator<<(std::ostream& out, const Gate& gate) { return out << gate.budget; }

[[nodiscard]] std::vector<Gate> gates() {
  const char* const latency = "ServiceLatency.*";
  const char* const hold = "SmoothHold.StopsInLittle*";
  return {
      {"cycle_heap_calls", "rt_step_watch_test", "*CountsNothing/Abort", true},
      {"cycle_locks", "rt_step_watch_test", "*CountsNothing/Abort", true},
      {"cycle_page_faults", "rt_step_watch_test", "*CountsNothing/Abort", true},
      {"flight_recorder_memory", "unit_telemetry", "FlightFiles.OfMoreSecondsThanFit*", true},
      {"instructions_trace_off", "instruction_gate_test", "*TracingThatIsOff", true},
      {"instructions_inverse_kinematics", "instruction_gate_test", "*.InverseKinematics"},
      {"instructions_inverse_kinematics_chain", "instruction_gate_test", "*OfAnyChain"},
      {"instructions_inverse_kinematics_robot_5r", "instruction_gate_test", "*Robot5R"},
      {"instructions_inverse_kinematics_robot_6r", "instruction_gate_test", "*Robot6R"},
      {"instructions_cycle", "instruction_gate_test", "*.Cycle"},
      {"instructions_cycle_single_block", "instruction_gate_test", "*SeeksTheEnd*"},
      {"instructions_cycle_over_windows", "instruction_gate_test", "*TheDearestCycle*"},
      {"instructions_monitoring", "instruction_gate_test", "*.MonitoringBesideACycle"},
      {"instructions_monitoring_all", "instruction_gate_test", "*MonitoringOfEverything*"},
      {"instructions_setpoint_spline", "instruction_gate_test", "*SetpointOnASpline"},
      {"instructions_setpoint_pole", "instruction_gate_test", "*SetpointBesideThePole"},
      {"instructions_planner", "instruction_gate_test", "*.Planner"},
      {"instructions_smooth_block", "instruction_gate_test", "*SmoothPlannerPerBlock"},
      {"instructions_smooth_dense_block", "instruction_gate_test", "*PerDenseBlock"},
      {"instructions_smooth_window", "instruction_gate_test", "*PerHostileWindow"},
      {"publisher_lock_waits", "integration_counters", "*AWholeRun*"},
      {"start_time", "integration_service", "Service.AnswersInOff*"},
      {"resident_memory", "integration_service", "Service.AnswersInOff*"},
      {"start_to_ready", "integration_service", "Service.IsReady*"},
      {"hold_reaction", "integration_service", "LiveReaction.OfAHold*"},
      {"stop_time", "rt_motion_test", "StoppingTime.*"},
      {"smooth_stop_late", "rt_motion_test", hold},
      {"smooth_stop_late_attainable", "rt_motion_test", hold},
      {"smooth_stop_late_by", "rt_motion_test", hold},
      {"smooth_stop_far_by", "rt_motion_test", hold},
      {"smooth_stop_time_p75", "rt_motion_test", hold},
      {"smooth_stop_length_p75", "rt_motion_test", hold},
      {"planner_drift", "smooth_property_test", "SmoothThroughput.*"},
      {"planner_growth", "smooth_property_test", "SmoothThroughput.*"},
      {"traversal_time", "bench_paths_test", "Files/BenchPaths.*/fan"},
      {"cycle_lateness", "latency_service_test", latency},
      {"setpoint_latency_p50", "latency_service_test", latency},
      {"setpoint_latency_p99", "latency_service_test", latency},
      {"setpoints_unseen", "latency_service_test", latency},
  };
}

/// The table with a row that nothing keeps; figures are never negative. Measurements of turns take
/// one turn: which verdict it comes to is all that is asked.
[[nodiscard]] std::string broken_table(const std::string& budget) {
  std::ifstream in(kTable);
  std::ostringstream out;
  std::string row;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('[')) row = line.substr(1, line.find(']') - 1);
    if (row == budget) {
      line = std::regex_replace(line, std::regex("^(limit|plus) = .*"), "$1 = -1");
      line = std::regex_replace(line, std::regex("^factor = .*"), "factor = 0");
      line = std::regex_replace(line, std::regex("^at_least = .*"), "at_least = 1e18");
    } else if (row == "turns_taken") {
      line = std::regex_replace(line, std::regex("^at_least = .*"), "at_least = 1");
    }
    out << line << "\n";
  }
  return out.str();
}

[[nodiscard]] test::CommandOutput run_against(const std::string& table, const Gate& gate) {
  const process::ScratchFolder folder;
  std::ofstream(folder.path() / "budgets.toml") << table;
  return test::run_command("MERIDIAN_SHARE='" + folder.path().string() +
                           "' '" MERIDIAN_BINARY_DIR "/bin/" + gate.program +
                           "' '--gtest_filter=" + gate.filter + "' 2>&1");
}

class BrokenGate : public testing::TestWithParam<Gate> {};

TEST_P(BrokenGate, IsRed) {
  const Gate& gate = GetParam();
  const test::CommandOutput red = run_against(broken_table(gate.budget), gate);
  const bool has_run = red.exit_code != 0 || red.output.find("[       OK ]") != std::string::npos;
  if (!has_run) GTEST_SKIP() << "the gate itself skips here: " << red.output;
  EXPECT_EQ(red.exit_code, 1) << red.output;
  EXPECT_NE(red.output.find("[  FAILED  ] "), std::string::npos) << red.output;
  EXPECT_EQ(red.output.find("C++ exception"), std::string::npos)
      << "it does not even read the table: " << red.output;
  if (std::string(gate.program) == "latency_service_test") {
    const std::string verdict = std::string("OUTSIDE ") + gate.budget;
    EXPECT_NE(red.output.find(verdict), std::string::npos) << "red by another: " << red.output;
  }
  if (!gate.is_quick) return;
  const test::CommandOutput green = run_against(test::read_text(kTable), gate);
  EXPECT_EQ(green.exit_code, 0) << "as the table is: " << green.output;
}

[[nodiscard]] std::vector<Gate> gates_to_break() {
  std::vector<Gate> all = gates();
  if (std::getenv("MERIDIAN_BREAK_GATES") == nullptr) {
    std::erase_if(all, [](const Gate& gate) { return !gate.is_quick; });
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Of, BrokenGate, testing::ValuesIn(gates_to_break()),
                         [](const auto& one) { return std::string(one.param.budget); });

TEST(Gates, AreAllOfThoseThatTheTableSaysTestsCheck) {
  std::set<std::string> checked, broken;
  for (const probe::Budget& one : probe::load_budgets(kTable)) {
    const bool is_by_test = std::regex_search(
        one.checked, std::regex("(unit|integration|property|latency|corpus) test"));
    if (is_by_test || one.name.starts_with("instructions_")) checked.insert(one.name);
  }
  checked.erase("turns_taken");  // it says how long the gate measures; a wrong one never ends
  for (const Gate& gate : gates()) broken.insert(gate.budget);
  EXPECT_EQ(broken, checked);
}

}  // namespace
}  // namespace meridian
