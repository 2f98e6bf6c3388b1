// SPDX-License-Identifier: Apache-2.0
#include "service/probe/service_setup.hpp"

#include <fstream>

#include "service/process/programs.hpp"

namespace meridian::probe {

std::vector<std::string> ServiceSetup::command(const std::filesystem::path& recording) const {
  const std::filesystem::path file = folder / "service.toml";
  std::ofstream(file) << "[service]\nmachine = \"" << std::filesystem::absolute(machine).string()
                      << "\"\n\n[realtime]\n"
                      << "mode = \"best_effort\"\ncpu = " << realtime.cpu
                      << "\ncycle_priority = " << realtime.cycle_priority
                      << "\npublisher_priority = " << realtime.publisher_priority
                      << "\ncommands_priority = " << realtime.commands_priority
                      << "\nplanner_priority = " << realtime.planner_priority
                      << "\nlock_memory = " << (realtime.lock_memory ? "true" : "false")
                      << "\nhold_dma_latency = " << (realtime.hold_dma_latency ? "true" : "false")
                      << "\n";
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
