// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/service_setup.hpp"

#include <fstream>
#include <sstream>

#include "service/host/process/programs.hpp"

namespace meridian::probe {

std::string realtime_section(const config::RealtimeConfig& realtime) {
  const auto truth = [](bool is) { return is ? "true" : "false"; };
  std::ostringstream text;
  text << "[realtime]\nmode = "
       << (realtime.mode == config::RealtimeMode::kEnforce ? "\"enforce\"" : "\"best_effort\"")
       << "\ncpu = " << realtime.cpu << "\ncycle_priority = " << realtime.cycle_priority
       << "\npublisher_priority = " << realtime.publisher_priority
       << "\ncommands_priority = " << realtime.commands_priority
       << "\nio_priority = " << realtime.io_priority
       << "\nplanner_priority = " << realtime.planner_priority
       << "\nlock_memory = " << truth(realtime.lock_memory)
       << "\nhold_dma_latency = " << truth(realtime.hold_dma_latency) << "\n";
  return text.str();
}

std::vector<std::string> ServiceSetup::command(const std::filesystem::path& recording) const {
  const std::filesystem::path file = folder / "service.toml";
  config::RealtimeConfig best = realtime;
  best.mode = config::RealtimeMode::kBestEffort;
  std::ofstream(file) << "[service]\nmachine = \"" << std::filesystem::absolute(machine).string()
                      << "\"\n\n"
                      << realtime_section(best);
  return {process::program_beside("meridiand").string(),
          "--service",
          file.string(),
          "--domain",
          std::to_string(domain),
          "--record",
          recording.string(),
          "--best-effort"};
}

}  // namespace meridian::probe
