// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <thread>

#include "service/host/probe/doctor/doctor.hpp"

namespace meridian::probe {
namespace {

constexpr int kCyclePriority = 80;

/// The folder of this process in the hierarchy of `controller` (version 2 of control groups: the
/// one without a name); empty where there is none.
[[nodiscard]] std::string group_of(const HostFiles& host, const std::string& controller) {
  std::string wanted(1, ',');
  wanted.append(controller).append(1, ',');
  std::istringstream lines(host.text("proc/self/cgroup").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    std::string names(1, ',');
    names.append(line, first + 1, second - first - 1).append(1, ',');
    if (names.find(wanted) != std::string::npos) return line.substr(second + 1);
  }
  return {};
}

[[nodiscard]] Finding priority(const HostFiles& host, const Rights& rights) {
  Finding out{"real-time priority", Health::kFine, "threads may run at FIFO 80", ""};
  if (rights.has_priority) return out;
  out.health = Health::kBad;
  const std::string group = group_of(host, "cpu");
  if (!group.empty() &&
      host.number("sys/fs/cgroup/cpu" + group + "/cpu.rt_runtime_us") == std::optional(0LL)) {
    out.found = "refused: the cpu control group " + group + " has no real-time share";
    out.remedy = "write 950000 to /sys/fs/cgroup/cpu" + group +
                 "/cpu.rt_runtime_us (the groups above it first), or run in the root group";
  } else {
    out.found = "refused";
    out.remedy =
        "run as root, grant CAP_SYS_NICE, or LimitRTPRIO=80 in the unit or "
        "/etc/security/limits.d";
  }
  return out;
}

[[nodiscard]] Finding throttling(const HostFiles& host) {
  Finding out{"real-time throttling", Health::kFine, "off", ""};
  const auto runtime = host.number("proc/sys/kernel/sched_rt_runtime_us");
  const auto period = host.number("proc/sys/kernel/sched_rt_period_us");
  if (!runtime || !period) {
    out.found = "not reported by this kernel";
  } else if (*runtime >= 0 && *runtime < *period) {
    out.health = Health::kNote;
    out.found = "real-time threads together get " + std::to_string(*runtime) + " of every " +
                std::to_string(*period) + " us";
    out.remedy =
        "harmless while cycle and publisher leave that rest idle; to be sure: "
        "sysctl kernel.sched_rt_runtime_us=-1";
  }
  return out;
}

/// The groups that a unit is in, from above: whether one of them has no real-time share.
[[nodiscard]] std::string group_without_share(const HostFiles& host) {
  for (const char* const group : {"/system.slice", "/system.slice/meridiand.service"}) {
    const auto share = host.number("sys/fs/cgroup/cpu" + std::string(group) + "/cpu.rt_runtime_us");
    if (share == std::optional(0LL)) return group;
  }
  return {};
}

/// Whether a kernel with CONFIG_RT_GROUP_SCHED was built or started (from Linux 6.16 on) to leave
/// it off.
[[nodiscard]] bool is_left_off(const HostFiles& host, const std::string& options) {
  const auto option = host.boot_option("rt_group_sched");
  if (option) return *option == "0" || *option == "n" || *option == "off";
  return options.find("\nCONFIG_RT_GROUP_SCHED_DEFAULT_DISABLED=y") != std::string::npos;
}

/// Version 2 has no file for the share: a kernel with the option refuses all but the root group
/// wherever the cpu controller is on.
[[nodiscard]] bool refuses_in_two(const HostFiles& host) {
  const std::string release = host.text("proc/sys/kernel/osrelease").value_or("");
  const std::string options = host.text("boot/config-" + release).value_or("");
  if (options.find("\nCONFIG_RT_GROUP_SCHED=y") == std::string::npos) return false;
  if (is_left_off(host, options)) return false;
  std::istringstream on(host.text("sys/fs/cgroup/cgroup.subtree_control").value_or(""));
  for (std::string controller; on >> controller;) {
    if (controller == "cpu") return true;
  }
  return false;
}

/// A share of processor time that is used up stops every thread until the next period.
[[nodiscard]] Finding quota(const HostFiles& host) {
  Finding out{"processor quota", Health::kFine, "none", ""};
  const std::string two = group_of(host, "");
  const auto max = host.text("sys/fs/cgroup" + (two.empty() ? "/" : two) + "/cpu.max");
  const std::string one = group_of(host, "cpu");
  const auto share = host.number("sys/fs/cgroup/cpu" + one + "/cpu.cfs_quota_us");
  const bool has_two = max && !max->starts_with("max");
  if (!has_two && share.value_or(-1) <= 0) return out;
  out.health = Health::kBad;
  out.found = "the control group may use " + (has_two ? *max : std::to_string(*share)) +
              " us, then its threads are stopped";
  out.remedy = has_two ? "write max to its cpu.max, or CPUQuota= without a value in the unit"
                       : "write -1 to its cpu.cfs_quota_us";
  return out;
}

}  // namespace

Findings examine_service_group(const HostFiles& host) {
  const std::string what = "real time in a unit";
  const std::string top = "sys/fs/cgroup/cpu/cpu.rt_runtime_us";
  if (const std::string group = group_without_share(host); !group.empty()) {
    return {{what, Health::kBad,
             "the cpu control group " + group +
                 " has no real-time share: a service that systemd puts there is refused FIFO",
             "write 950000 to /sys/fs/cgroup/cpu" + group +
                 "/cpu.rt_runtime_us and to the groups below it, from a unit before meridiand"}};
  }
  if (refuses_in_two(host)) {
    return {{what, Health::kBad,
             "this kernel (CONFIG_RT_GROUP_SCHED) refuses FIFO outside of the root control group "
             "while the cpu controller is on",
             "a kernel without CONFIG_RT_GROUP_SCHED (Debian's has none), or from Linux 6.16 on "
             "boot with "
             "rt_group_sched=0; and no CPUWeight=, CPUQuota= in any unit"}};
  }
  if (host.number(top)) {
    return {{what, Health::kNote,
             "this kernel shares real time out among control groups, and a new one gets none: "
             "CPUWeight=, CPUQuota= or CPUAccounting= of any unit makes one for the service",
             "leave these out of units, or write 950000 to cpu.rt_runtime_us of the groups that "
             "they make"}};
  }
  return {{what, Health::kFine, "not shared out among control groups", ""}};
}

Rights try_rights() {
  Rights out;
  std::thread([&out] {
    const sched_param wish{.sched_priority = kCyclePriority};
    out.has_priority = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wish) == 0;
  }).join();
  constexpr std::size_t kTrial_bytes = kLockedMemory_mib << 20U;
  void* const trial =
      mmap(nullptr, kTrial_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial != MAP_FAILED) {
    out.has_locked_memory = mlock(trial, kTrial_bytes) == 0;
    munmap(trial, kTrial_bytes);
  }
  out.has_dma_latency = access("/dev/cpu_dma_latency", W_OK) == 0;
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) out.cpus = CPU_COUNT(&set);
  return out;
}

Findings examine_rights(const HostFiles& host, const Rights& rights) {
  Findings out{priority(host, rights)};
  out.push_back(rights.has_locked_memory
                    ? Finding{"locked memory", Health::kFine,
                              std::to_string(kLockedMemory_mib) + " MiB can be locked", ""}
                    : Finding{"locked memory", Health::kBad, "refused: pages may leave memory",
                              "run as root, grant CAP_IPC_LOCK, or LimitMEMLOCK=infinity"});
  out.push_back(throttling(host));
  out.push_back(quota(host));
  return out;
}

}  // namespace meridian::probe
