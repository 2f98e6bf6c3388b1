// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "support/alarm_letter.hpp"
#include "support/document_table.hpp"
#include "support/draws.hpp"
#include "unit/daemon/machine_phases.hpp"

/// Every fault that can be rehearsed in every phase of the machine. The table of docs/faults.md is
/// what this test finds.
namespace meridian::test {
namespace {

constexpr std::array<const char*, 20> kFaults{
    "fault:theta2", "unpowered:b2",    "blocked:*",   "lag:*=500", "frozen:*",
    "spike:b3=10",  "nan:theta1",      "mute:theta1", "silence",   "dead",
    "emergency",    "unreferenced:b4", "deaf=3",      "deaf=100",  "late=20",
    "untold",       "stale=10",        "stale=100",   "doubled",   "swapped"};

/// What comes of `fault` in `phase`: the letter of the alarm after a FaultStop, or a dot.
std::string outcome(const Phase& phase, const char* fault) {
  SCOPED_TRACE(testing::Message() << fault << " in " << phase.name);
  const drives::HomingPlan homing{.is_referenced = !phase.is_unreferenced};
  auto plant = std::make_unique<Rehearsal>(std::vector<drives::HomingPlan>(5, homing));
  phase.begin(*plant);
  const std::size_t first = plant->world.records.size();
  plant->inject(fault);
  const bool is_fault = plant->until(State::kFault, 6);
  if (phase.tip_at == TipAt::kOnLine) {
    EXPECT_LE(plant->deviation(first), 1e-9) << "mm off the path";
  }
  if (phase.tip_at != TipAt::kNone) {
    EXPECT_LE(plant->acceleration(first), 1 + 1e-6);
  }
  EXPECT_NE(plant->world.now(), State::kFaultStop);
  const Alarm alarm = plant->world.state.alarm;
  if (is_fault) {
    EXPECT_EQ(plant->world.records.back().setpoint.flags & kSetpointEnabled, 0);
  }
  expect_recovery(*plant);
  return is_fault ? letter_of(alarm) : "·";
}

std::string faults_and_phases() {
  std::ostringstream text;
  text << kFaults.size() << " faults in " << kMachinePhases.size() << " phases, "
       << kFaults.size() * kMachinePhases.size() << " pairs:\n\n| |";
  for (const std::string_view fault : kFaults) {
    const bool has_number =
        fault.starts_with("deaf") || fault.starts_with("late") || fault.starts_with("stale");
    text << " `" << fault.substr(0, fault.find_first_of(has_number ? "" : ":=")) << "` |";
  }
  text << "\n|---|";
  for (std::size_t i = 0; i < kFaults.size(); ++i) text << "---|";
  for (const Phase& phase : kMachinePhases) {
    text << "\n| " << phase.name << " |";
    for (const char* fault : kFaults) text << ' ' << outcome(phase, fault) << " |";
  }
  text << '\n';
  return text.str();
}

TEST(FaultPhases, EndAsTheDocumentSaysOnThePathInsideLimitsAndCanBeMended) {
  if (!kIsTimed) {  // a sanitizer sees the same code in some of the pairs
    for (std::size_t n = 0; n < kFaults.size() * kMachinePhases.size(); n += 13) {
      (void)outcome(kMachinePhases[n % kMachinePhases.size()], kFaults[n % kFaults.size()]);
    }
    return;
  }
  expect_table_of_document(MERIDIAN_SOURCE_DIR "/docs/faults.md", "phases", faults_and_phases());
}

}  // namespace
}  // namespace meridian::test
