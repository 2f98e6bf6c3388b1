// SPDX-License-Identifier: Apache-2.0
#include "service/panel/program/program_text.hpp"

#include <nlohmann/json.hpp>

#include "service/panel/json_text.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

[[nodiscard]] const char* name_of(ProgramDesk::Phase phase) {
  switch (phase) {
    case ProgramDesk::Phase::kNone:
      return "none";
    case ProgramDesk::Phase::kChecking:
      return "checking";
    case ProgramDesk::Phase::kRefused:
      return "refused";
    case ProgramDesk::Phase::kReady:
      return "ready";
    case ProgramDesk::Phase::kStreaming:
      return "streaming";
  }
  return "none";
}

[[nodiscard]] json findings_json(const std::vector<cl::Finding>& findings) {
  json out = json::array();
  for (const cl::Finding& finding : findings) {
    out.push_back({{"line", finding.line},
                   {"refusal", finding.severity == cl::Finding::Severity::kRefusal},
                   {"message", finding.message},
                   {"remedy", finding.remedy},
                   {"count", finding.count}});
  }
  return out;
}

}  // namespace

std::string program_text(const ProgramDesk::View& view) {
  return json_text({{"t", "program"},
                    {"phase", name_of(view.phase)},
                    {"name", view.program.name},
                    {"station", view.station},
                    {"bytes", view.program.bytes},
                    {"lines", view.program.lines},
                    {"first_line", view.first_line},
                    {"blocks", view.preflight.blocks},
                    {"at_feed_s", view.preflight.times.total_s()},
                    {"findings", findings_json(view.preflight.findings)},
                    {"placing", view.placing},
                    {"simulating", view.is_simulating},
                    {"path", view.path_number},
                    {"has_run", view.simulated.has_run},
                    {"reason", view.simulated.reason},
                    {"approach_s", view.simulated.approach_s},
                    {"program_s", view.simulated.program_s},
                    {"waiting_s", view.simulated.waiting_s},
                    {"limits", view.simulated.limits},
                    {"message", view.message}});
}

}  // namespace meridian::panel
