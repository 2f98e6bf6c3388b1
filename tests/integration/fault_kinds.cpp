// SPDX-License-Identifier: Apache-2.0
#include "integration/fault_kinds.hpp"

#include <array>
#include <cstdlib>
#include <string_view>

namespace meridian::test {
namespace {

using How = LiveFault::How;
using Where = Phase::Where;

constexpr std::array<Phase, 12> kPhases{{
    {"Ready", Where::kReady},
    {"Approaching", Where::kBegin},
    {"in a cut, smooth", Where::kCut},
    {"in a cut, exact stop", Where::kCut, "exact_stop"},
    {"in a rapid", Where::kRapid},
    {"on the pole", Where::kPole},
    {"Holding", Where::kHolding},
    {"Held", Where::kHeld},
    {"in a dwell", Where::kDwell},
    {"at a tool change", Where::kTool},
    {"Starved", Where::kStarved, "exact_stop"},
    {"in the last block", Where::kEnd},
}};

constexpr const char* kAllBlocked = "blocked:b3\nblocked:b2\nblocked:b4\nblocked:theta1\n";

// The service bridges 100 ms and waits 300 ms for feedback (service_file() of live_run.hpp).
const std::array<LiveFault, 34> kFaults{{
    {"station killed", How::kStationDies, "", "S", "S"},
    {"station stopped", How::kStationStops, "", "S", "S"},
    {"service killed", How::kServiceDies, "", "X", "X"},
    {"service stopped, 30 ms", How::kStall, "", "·", "·", 30},
    {"service stopped, 700 ms", How::kStall, "", "DPL", "DL", 700},
    {"drives killed", How::kDrivesDie, "", "L", "L"},
    {"`fault`", How::kConsole, "fault:theta2", "D", "D"},
    {"`unpowered`", How::kConsole, "unpowered:b2", "D", "D"},
    {"`blocked`", How::kConsole, kAllBlocked, "FD", "·"},
    // A report that is followed by another one before the cycle looks is not seen.
    {"`spike`", How::kConsole, "spike:b3", "F", "F", 0, {}, 5},
    {"`nan`", How::kConsole, "nan:theta1", "L", "L"},
    {"`mute`", How::kConsole, "mute:theta1", "L", "L"},
    {"`silence`", How::kConsole, "silence", "L", "L"},
    {"`dead`", How::kConsole, "dead", "L", "L"},
    {"`emergency`", How::kConsole, "emergency", "E", "E"},
    {"`unreferenced`", How::kConsole, "unreferenced:b4", "R", "R"},
    {"`untold`", How::kConsole, "untold", "U", "U"},
    {"`deaf`, 30 ms", How::kConsole, "deaf=15", "·", "·"},
    {"`deaf`, 600 ms", How::kConsole, "deaf=300", "D", "D"},
    {"`late`, 20 ms", How::kConsole, "late=10", "·", "·"},
    {"`stale`, 20 ms", How::kConsole, "stale=10", "·", "·"},
    {"`doubled`", How::kConsole, "doubled", "·", "·"},
    {"`swapped`", How::kConsole, "swapped", "·", "·"},
    {"set-up words", How::kSetUp, "", "·", "·"},
    {"a stranger's rubbish", How::kRubbish, "", "·", "·"},
    {"stuck participant", How::kStuck, "stick --topics all --max-samples 1 --lease 600", "·", "·"},
    {"forged sender", How::kAttacker,
     "flood --topics drive_command,setpoint --shape forged --rate 1000", "·", "·"},
    {"log blocked", How::kBlockedLog, "flood --topics command --shape foreign --rate 500", "·",
     "·"},
    {"recovery killed twice", How::kRecoveryDies, "", "X", "X"},
    {"wire: 5 % lost", How::kWire, "", "·", "·", 0, {.lost = 5}},
    {"wire: 5 ms late", How::kWire, "", "·", "·", 0, {.delay_ms = 5, .jitter_ms = 1}},
    {"wire: 5 % twice", How::kWire, "", "·", "·", 0, {.twice = 5}},
    {"wire: 5 % past others",
     How::kWire,
     "",
     "·",
     "·",
     0,
     {.delay_ms = 3, .jitter_ms = 1, .past_others = 5}},
    {"wire: 5 % spoilt", How::kWire, "", "·", "·", 0, {.wrong = 5}},
}};

}  // namespace

bool is_whole_matrix() {
  const char* const asked = std::getenv("MERIDIAN_FAULT_MATRIX");
  return asked != nullptr && std::string_view(asked) == "all";
}

std::span<const Phase> phases() { return kPhases; }
std::span<const LiveFault> live_faults() { return kFaults; }

std::string expected(const LiveFault& fault, const Phase& phase) {
  const bool is_ready = phase.where == Where::kReady;
  if (is_ready && fault.is_of_station()) return "–";  // there is none
  const bool is_unreferenced = std::string_view(fault.name) == "`unreferenced`";
  if (is_ready && is_unreferenced) return "·";
  // A hold may end before the shafts that are stuck are missed.
  if (phase.where == Where::kHolding && std::string_view(fault.moving) == "FD") return "·FD";
  return phase.waits() ? fault.resting : fault.moving;
}

std::string table_of_faults() {
  std::string text = "| |";
  for (const Phase& phase : kPhases) text += std::string(" ") + phase.name + " |";
  text += "\n|---|";
  for (std::size_t i = 0; i < kPhases.size(); ++i) text += "---|";
  int pairs = 0;
  for (const LiveFault& fault : kFaults) {
    text += std::string("\n| ") + fault.name + " |";
    for (const Phase& phase : kPhases) {
      const std::string letters = expected(fault, phase);
      pairs += letters == "–" ? 0 : 1;
      text += " " + letters + " |";
    }
  }
  return std::to_string(kFaults.size()) + " faults, " + std::to_string(kPhases.size()) +
         " phases, " + std::to_string(pairs) + " pairs:\n\n" + text + "\n";
}

}  // namespace meridian::test
