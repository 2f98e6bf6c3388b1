// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <sstream>

#include "service/probe/doctor.hpp"

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

/// What the kernel was told behind KEY= when it was started.
[[nodiscard]] std::string boot_option(const HostFiles& host, const std::string& key) {
  std::istringstream words(host.text("proc/cmdline").value_or(""));
  std::string value;
  for (std::string word; words >> word;) {
    if (word.starts_with(key + "=")) value = word.substr(key.size() + 1);
  }
  return value;
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
  const std::string remedy = "boot with isolcpus=managed_irq,domain," + number +
                             " nohz_full=" + number + " rcu_nocbs=" + number;
  if (!has(isolated, cpu)) {
    if (isolated.empty()) {
      return {{what, Health::kNote, name + ", not isolated: anything may run beside the cycle",
               remedy + " and set [realtime] cpu = " + number}};
    }
    return {{what, Health::kNote, name + ", not isolated; that is " + isolated,
             "set [realtime] cpu to one of these in the service file, or " + remedy}};
  }
  std::string missing;
  if (!has(host.text(kCpu + "nohz_full").value_or(""), cpu)) missing = "nohz_full";
  if (!has(boot_option(host, "rcu_nocbs"), cpu))
    missing += missing.empty() ? "rcu_nocbs" : ", rcu_nocbs";
  if (missing.empty()) {
    return {{what, Health::kFine, name + ", isolated, tickless, without callbacks", ""}};
  }
  return {{what, Health::kNote,
           name + ", isolated, without " + missing + ": the kernel still interrupts it", remedy}};
}

}  // namespace meridian::probe
