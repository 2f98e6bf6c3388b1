// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <sstream>

#include "service/host/probe/doctor/doctor.hpp"

namespace meridian::probe {
namespace {

const std::string kCpu = "sys/devices/system/cpu/";

/// Whether a list of the kernel ("0-2,5") has `cpu`.
[[nodiscard]] bool has(const std::string& list, int cpu) {
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    char* end = nullptr;
    const long first = std::strtol(part.c_str(), &end, 10);
    if (end == part.c_str()) continue;
    const long last = *end == '-' ? std::strtol(end + 1, nullptr, 10) : first;
    if (first <= cpu && cpu <= last) return true;
  }
  return false;
}

/// What the kernel still does on an isolated processor, of what options can switch off; empty:
/// nothing. Where it ticks no more (nohz_full) it runs no callbacks either, by itself.
[[nodiscard]] std::string not_kept_off(const HostFiles& host, int cpu) {
  if (has(host.text(kCpu + "nohz_full").value_or(""), cpu)) return {};
  const std::string offloaded = host.boot_option("rcu_nocbs").value_or("");
  return offloaded == "all" || has(offloaded, cpu) ? "nohz_full" : "nohz_full, rcu_nocbs";
}

}  // namespace

Findings examine_isolation(const HostFiles& host, int cpu) {
  const std::string number = std::to_string(cpu), name = "processor " + number;
  const std::string what = "the cycle's processor";
  const std::string online = host.text(kCpu + "online").value_or("");
  if (!online.empty() && !has(online, cpu)) {
    return {{what, Health::kBad, name + ", of those that are there: " + online,
             "set [realtime] cpu in the service file"}};
  }
  const std::string isolated = host.text(kCpu + "isolated").value_or("");
  // Linux keeps its own work on the first; on a host of one there is nowhere else.
  const bool is_first = cpu == 0 || online == number;
  const std::string remedy = "boot with isolcpus=managed_irq,domain," + number +
                             " nohz_full=" + number + " rcu_nocbs=" + number;
  if (is_first) {
    return {{what, Health::kNote, name + ", on which the kernel does its own work",
             "choose another in [realtime] cpu of the service file, one that is isolated" +
                 (isolated.empty() ? "" : ": " + isolated) +
                 (online == number ? "; this host has no other" : "")}};
  }
  if (!has(isolated, cpu)) {
    if (isolated.empty()) {
      return {{what, Health::kNote, name + ", not isolated: anything may run beside the cycle",
               remedy + " and set [realtime] cpu = " + number}};
    }
    return {{what, Health::kNote, name + ", not isolated; that is " + isolated,
             "set [realtime] cpu to one of these in the service file, or " + remedy}};
  }
  const std::string missing = not_kept_off(host, cpu);
  if (missing.empty()) {
    return {{what, Health::kFine, name + ", isolated, tickless, without callbacks", ""}};
  }
  return {{what, Health::kNote,
           name + ", isolated, without " + missing + ": the kernel still interrupts it", remedy}};
}

}  // namespace meridian::probe
