// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "service/host/probe/doctor/doctor.hpp"

namespace meridian::probe {
namespace {

[[nodiscard]] Finding flavour(const HostFiles& host) {
  const std::string release = host.text("proc/sys/kernel/osrelease").value_or("unknown");
  const std::string version = host.text("proc/sys/kernel/version").value_or("");
  if (host.number("sys/kernel/realtime").value_or(0) == 1 ||
      version.find("PREEMPT_RT") != std::string::npos) {
    return {"kernel", Health::kFine, release + ", PREEMPT_RT", ""};
  }
  return {"kernel", Health::kNote, release + " without PREEMPT_RT",
          "apt install linux-image-rt-amd64; without it drivers delay the cycle by milliseconds "
          "under load"};
}

[[nodiscard]] Finding clock(const HostFiles& host) {
  const std::string source =
      host.text("sys/devices/system/clocksource/clocksource0/current_clocksource").value_or("");
  if (source == "tsc" || source == "kvm-clock" || source == "arch_sys_counter" ||
      source == "hyperv_clocksource_tsc_page") {
    return {"clock source", Health::kFine, source, ""};
  }
  return {"clock source", Health::kBad, source.empty() ? "not reported" : source,
          "reading it costs a microsecond or more and may be a system call; see why tsc was given "
          "up: dmesg | grep -i clocksource"};
}

/// Timers that fire at the tick alone wake the cycle up to 4 ms late.
[[nodiscard]] Finding timers(const HostFiles& host) {
  const auto list = host.text("proc/timer_list");
  if (!list) return {"high-resolution timers", Health::kFine, "shown to root alone", ""};
  if (list->find(".hres_active    : 1") != std::string::npos) {
    return {"high-resolution timers", Health::kFine, "on", ""};
  }
  return {"high-resolution timers", Health::kBad, "off: wake-ups come at the tick",
          "a kernel with CONFIG_HIGH_RES_TIMERS, booted without highres=off"};
}

[[nodiscard]] Finding swap(const HostFiles& host) {
  const std::string swaps = host.text("proc/swaps").value_or("");
  if (std::count(swaps.begin(), swaps.end(), '\n') == 0) {
    return {"swap", Health::kFine, "none", ""};
  }
  return {"swap", Health::kNote, "on: the service locks its memory, what it talks to may wait",
          "swapoff -a"};
}

[[nodiscard]] Finding huge_pages(const HostFiles& host) {
  const std::string mode =
      host.text("sys/kernel/mm/transparent_hugepage/enabled").value_or("[never]");
  if (mode.find("[always]") == std::string::npos) {
    return {"transparent huge pages", Health::kFine, "only where asked for", ""};
  }
  return {"transparent huge pages", Health::kNote, "always: memory is moved at any time",
          "write madvise to /sys/kernel/mm/transparent_hugepage/enabled"};
}

[[nodiscard]] Finding interrupts(const HostFiles& host) {
  for (const std::string& pid : host.names("proc", "")) {
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    if (host.text("proc/" + pid + "/comm") != std::optional<std::string>("irqbalance")) continue;
    return {"interrupts", Health::kNote, "irqbalance moves them, also to the real-time cpu",
            "set IRQBALANCE_BANNED_CPULIST to the real-time cpu, or stop irqbalance"};
  }
  return {"interrupts", Health::kFine, "nothing moves them", ""};
}

}  // namespace

Findings examine_kernel(const HostFiles& host) {
  return {flavour(host), clock(host), timers(host), swap(host), huge_pages(host), interrupts(host)};
}

}  // namespace meridian::probe
