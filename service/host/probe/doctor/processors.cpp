// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "service/host/probe/doctor/doctor.hpp"

namespace meridian::probe {
namespace {

const std::string kCpu = "sys/devices/system/cpu/";

[[nodiscard]] Finding count(const Rights& rights) {
  const std::string found = std::to_string(rights.cpus) + " for this process";
  if (rights.cpus > 1) return {"processors", Health::kFine, found, ""};
  return {"processors", Health::kBad, found,
          "the cycle needs one of its own: give the service two or more"};
}

[[nodiscard]] Finding frequency(const HostFiles& host) {
  Finding out{"clock frequency", Health::kFine, "not scaled here", ""};
  for (const std::string& cpu : host.names(kCpu, "cpu")) {
    const auto governor = host.text(kCpu + cpu + "/cpufreq/scaling_governor");
    if (!governor) continue;
    if (out.health == Health::kFine) out.found = "governor " + *governor;
    if (*governor == "performance") continue;
    out.health = Health::kNote;
    out.found = "governor " + *governor + " on " + cpu;
    out.remedy = "cpupower frequency-set -g performance";
  }
  return out;
}

/// Sleep states that take longer to leave than a cycle can spare.
[[nodiscard]] Finding sleep_states(const HostFiles& host, const Rights& rights) {
  constexpr long long kShallow_us = 20;
  long long deepest = 0;
  std::string name;
  for (const std::string& state : host.names(kCpu + "cpu0/cpuidle", "state")) {
    const std::string folder = kCpu + "cpu0/cpuidle/" + state + "/";
    const long long exit_us = host.number(folder + "latency").value_or(0);
    if (host.number(folder + "disable").value_or(0) != 0 || exit_us <= deepest) continue;
    deepest = exit_us;
    name = host.text(folder + "name").value_or(state);
  }
  const std::string found =
      deepest == 0 ? "none that a host's own kernel enters"
                   : "down to " + name + ", left in " + std::to_string(deepest) + " us";
  if (rights.has_dma_latency) {
    return {"sleep states", Health::kFine, found + "; the service holds them off", ""};
  }
  if (deepest <= kShallow_us) return {"sleep states", Health::kFine, found, ""};
  return {"sleep states", Health::kNote, found,
          "let the service's user write /dev/cpu_dma_latency (a udev rule), or boot with "
          "cpuidle.off=1"};
}

[[nodiscard]] Finding siblings(const HostFiles& host) {
  if (host.number(kCpu + "smt/active").value_or(0) == 0) {
    return {"threads of a core", Health::kFine, "one", ""};
  }
  return {"threads of a core", Health::kNote, "two: a neighbour slows the cycle down",
          "write off to /sys/devices/system/cpu/smt/control, or keep the sibling of the "
          "real-time cpu idle"};
}

[[nodiscard]] Finding virtualisation(const HostFiles& host) {
  const auto info = host.text("proc/cpuinfo").value_or("");
  if (info.find(" hypervisor") == std::string::npos) {
    return {"virtual machine", Health::kFine, "no", ""};
  }
  Finding out{"virtual machine", Health::kNote, "yes",
              "the host may take the processor away for milliseconds; cut on bare metal"};
  std::istringstream line(host.text("proc/stat").value_or(""));
  std::string word;
  double total = 0, stolen = 0;
  for (int column = 0; column < 9 && line >> word; ++column) {
    if (column == 0) continue;
    const double ticks = std::strtod(word.c_str(), nullptr);
    total += ticks;
    if (column == 8) stolen = ticks;
  }
  if (total > 0) {
    char share[64];
    std::snprintf(share, sizeof share, "yes; %.2f %% of its time was taken away since it started",
                  100 * stolen / total);
    out.found = share;
  }
  return out;
}

}  // namespace

Findings examine_processors(const HostFiles& host, const Rights& rights) {
  return {count(rights), frequency(host), sleep_states(host, rights), siblings(host),
          virtualisation(host)};
}

}  // namespace meridian::probe
