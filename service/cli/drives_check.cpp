// SPDX-License-Identifier: Apache-2.0
#include "service/cli/drives_check.hpp"

#include <chrono>
#include <cstdio>
#include <thread>

#include "service/cli/commands.hpp"
#include "service/drives/simulated/check/check_wire.hpp"
#include "service/drives/simulated/check/drive_check.hpp"
#include "service/transport/reader.hpp"

namespace meridian::cli {
namespace {

/// Whether a service is there: two of them would fight for the drives.
[[nodiscard]] bool is_served(const dds::ParticipantOptions& options) {
  dds::Participant participant(options);
  dds::Reader<dds::MachineInfo> machines(participant);
  dds::MachineInfo machine;
  for (int n = 0; n < 100; ++n) {
    while (machines.take(machine)) {
      if (machine.is_serving) return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// Whoever is at the machine, or a script, reads it at once.
void ask_operator(drives::Wish wish) {
  const bool is_open = wish == drives::Wish::kOpenEmergencyStop;
  std::printf("%s the emergency stop now\n", is_open ? "OPEN" : "CLOSE");
  std::fflush(stdout);
}

}  // namespace

int check_drives(const dds::ParticipantOptions& participant, const MachineModel& model,
                 drives::Operator operator_is) {
  if (is_served(participant)) {
    std::fprintf(stderr,
                 "meridian drives: a service serves machine %s; end it first: the check plays the "
                 "service\n",
                 participant.machine.c_str());
    return kMachineRefused;
  }
  drives::CheckWire wire(participant, model.cycle_ns, &ask_operator);
  const auto report = drives::DriveCheck(model, wire, [](const std::string& text) {
                        std::printf("checking: %s\n", text.c_str());
                        std::fflush(stdout);
                      }).run(operator_is);
  if (!report.has_drives) {
    std::fprintf(stderr, "meridian drives: nobody reports drives of machine %s\n",
                 participant.machine.c_str());
    return kNoPeer;
  }
  for (const std::string& step : report.unproven) {
    std::printf("not checked: %s; this host was busy, try again\n", step.c_str());
  }
  for (const drives::Finding& finding : report.findings) {
    const drives::RuleText& rule = drives::text_of(finding.rule);
    std::printf("BROKEN %s: %s; seen: %s (%s)\n", rule.name, rule.says, finding.seen.c_str(),
                rule.page);
  }
  const bool is_fine = report.findings.empty() && report.unproven.empty();
  const std::size_t unplayed = operator_is == drives::Operator::kAway ? 1 : 0;
  if (unplayed > 0) std::printf("emergency-stop is checked with --emergency-stop\n");
  std::printf("%s: %zu rules, %zu broken\n", is_fine ? "PASS" : "FAIL",
              drives::check_rules().size() - unplayed, report.findings.size());
  return is_fine ? kFine : kVerdictNo;
}

}  // namespace meridian::cli
