// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/doctor/doctor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "service/host/probe/budgets.hpp"
#include "service/host/probe/doctor/dds_network.hpp"
#include "service/host/process/programs.hpp"

namespace meridian::probe {
namespace {

namespace fs = std::filesystem;

/// A host made of files, in which all is well until a test says otherwise.
class Doctor : public testing::Test {
 protected:
  Doctor() {
    write("proc/self/cgroup", "4:cpu,cpuacct:/\n0::/\n");
    write("proc/sys/kernel/sched_rt_runtime_us", "-1\n");
    write("proc/sys/kernel/sched_rt_period_us", "1000000\n");
    write("proc/sys/kernel/osrelease", "6.1.0-rt\n");
    write("proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian\n");
    write("proc/cpuinfo", "flags : fpu tsc\n");
    write("proc/swaps", "Filename Type Size Used Priority\n");
    write("proc/sys/net/core/rmem_max", "4194304\n");
    write("sys/class/net/lo/operstate", "unknown\n");
    write("sys/class/net/lo/flags", "0x9\n");
    write("sys/devices/system/cpu/online", "0-3\n");
    write("proc/cmdline", "quiet isolcpus=managed_irq,domain,3 nohz_full=3 rcu_nocbs=2-3\n");
    write("proc/sys/kernel/timer_migration", "0\n");
    write("sys/devices/system/clockevents/clockevent0/current_device", "lapic-deadline\n");
    write("sys/devices/system/cpu/isolated", "3\n");
    write("sys/devices/system/cpu/nohz_full", "3\n");
    write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
    write("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
    write("sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never\n");
  }
  ~Doctor() override {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }

  [[nodiscard]] Findings examine() const {
    const HostFiles host(root_);
    Findings all = examine_rights(host, rights_);
    for (const Findings& more :
         {examine_service_group(host), examine_isolation(host, cpu_),
          examine_processors(host, rights_), examine_kernel(host), examine_clocks(host, time_),
          examine_network(host, ""), examine_dds_network(host, "", {})}) {
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }

  [[nodiscard]] Finding finding(const std::string& what) const {
    const Findings all = examine();
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&what](const Finding& one) { return one.what == what; });
    return at == all.end() ? Finding{} : *at;
  }

  /// `what` is of `health`, says `found` and has a remedy.
  void expect(const std::string& what, Health health, const std::string& found) const {
    const Finding one = finding(what);
    EXPECT_EQ(one.what, what);
    EXPECT_EQ(one.health, health) << what;
    EXPECT_NE(one.found.find(found), std::string::npos) << one.found;
    EXPECT_FALSE(one.remedy.empty()) << what;
  }

  Rights rights_{
      .has_priority = true, .has_locked_memory = true, .has_dma_latency = true, .cpus = 4};
  int cpu_ = 3;
  TimeOfDay time_{.is_synchronised = true, .max_error_s = 0.004};

 private:
  fs::path root_ = fs::temp_directory_path() / ("meridian-host-" + std::to_string(::getpid()));
};

TEST_F(Doctor, FindsNothingOnAHostMadeForRealTime) {
  for (const Finding& one : examine()) {
    EXPECT_EQ(one.health, Health::kFine) << one.what << ": " << one.found;
    EXPECT_TRUE(one.remedy.empty()) << one.what;
  }
  EXPECT_TRUE(is_fit(examine()));
}

TEST_F(Doctor, NamesTheControlGroupThatRefusesRealTime) {
  rights_.has_priority = false;
  expect("real-time priority", Health::kBad, "refused");
  write("proc/self/cgroup", "4:cpu,cpuacct:/user.slice/me\n0::/\n");
  write("sys/fs/cgroup/cpu/user.slice/me/cpu.rt_runtime_us", "0\n");
  expect("real-time priority", Health::kBad, "/user.slice/me");
  EXPECT_FALSE(is_fit(examine()));
}

TEST_F(Doctor, FindsAQuotaOfEitherKindOfControlGroup) {
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "50000\n");
  expect("processor quota", Health::kBad, "50000");
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1\n");
  EXPECT_EQ(finding("processor quota").health, Health::kFine);
  write("proc/self/cgroup", "0::/a.slice\n");
  write("sys/fs/cgroup/a.slice/cpu.max", "20000 100000\n");
  expect("processor quota", Health::kBad, "20000");
}

TEST_F(Doctor, FindsWhatRightsAreMissing) {
  rights_ = {.cpus = 1};
  expect("locked memory", Health::kBad, "refused");
  expect("processors", Health::kBad, "1 for this process");
  write("proc/sys/kernel/sched_rt_runtime_us", "950000\n");
  expect("real-time throttling", Health::kNote, "950000 of every 1000000 us");
}

TEST_F(Doctor, FindsWhatMakesProcessorsLate) {
  write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n");
  expect("clock frequency", Health::kNote, "powersave on cpu1");
  write("sys/devices/system/cpu/smt/active", "1\n");
  expect("threads of a core", Health::kNote, "two");
  write("proc/cpuinfo", "flags : fpu tsc hypervisor lahf\n");
  write("proc/stat", "cpu 100 0 100 700 0 0 0 100 0 0\ncpu0 1 1 1\n");
  expect("virtual machine", Health::kNote, "10.00 %");
}

TEST_F(Doctor, ExplainsTheTrapOfControlGroupsBeforeAServiceIsRefused) {
  ASSERT_TRUE(rights_.has_priority) << "the doctor itself may, in the root group";
  write("sys/fs/cgroup/cpu/cpu.rt_runtime_us", "950000\n");
  expect("real time in a unit", Health::kNote, "a new one gets none");
  write("sys/fs/cgroup/cpu/system.slice/cpu.rt_runtime_us", "950000\n");
  write("sys/fs/cgroup/cpu/system.slice/meridiand.service/cpu.rt_runtime_us", "0\n");
  expect("real time in a unit", Health::kBad, "/system.slice/meridiand.service has no real-time");
  write("sys/fs/cgroup/cpu/system.slice/cpu.rt_runtime_us", "0\n");
  expect("real time in a unit", Health::kBad, "group /system.slice has no real-time");
  EXPECT_FALSE(is_fit(examine()));
}

TEST_F(Doctor, ExplainsTheTrapOfTheSecondVersionOfControlGroups) {
  write("sys/fs/cgroup/cgroup.subtree_control", "cpuset cpu memory\n");
  EXPECT_EQ(finding("real time in a unit").health, Health::kFine);
  write("boot/config-6.1.0-rt", "CONFIG_CGROUPS=y\nCONFIG_RT_GROUP_SCHED=y\n");
  expect("real time in a unit", Health::kBad, "outside of the root control group");
  EXPECT_NE(finding("real time in a unit").remedy.find("from Linux 6.16 on"), std::string::npos);
  write("proc/cmdline", "quiet rt_group_sched=0\n");
  EXPECT_EQ(finding("real time in a unit").health, Health::kFine) << "started without it";
  write("proc/cmdline", "quiet\n");
  write("boot/config-6.1.0-rt",
        "A=y\nCONFIG_RT_GROUP_SCHED=y\nCONFIG_RT_GROUP_SCHED_DEFAULT_DISABLED=y\n");
  EXPECT_EQ(finding("real time in a unit").health, Health::kFine) << "built to leave it off";
  write("proc/cmdline", "quiet rt_group_sched=1\n");
  expect("real time in a unit", Health::kBad, "outside of the root control group");
  write("sys/fs/cgroup/cgroup.subtree_control", "cpuset memory\n");
  EXPECT_EQ(finding("real time in a unit").health, Health::kFine);
}

TEST_F(Doctor, LooksAtTheProcessorThatTheCycleIsGiven) {
  const std::string what = "the cycle's processor";
  EXPECT_EQ(finding(what).found, "processor 3, isolated, tickless, without callbacks");
  cpu_ = 1;
  expect(what, Health::kNote, "processor 1, not isolated; that is 3");
  cpu_ = 4;
  expect(what, Health::kBad, "of those that are there: 0-3");
  cpu_ = 3;
  write("proc/cmdline", "quiet rcu_nocbs=0-2\n");
  EXPECT_EQ(finding(what).health, Health::kFine) << "one without a tick has no callbacks either";
  write("sys/devices/system/cpu/nohz_full", "(null)\n");
  expect(what, Health::kNote, "without nohz_full, rcu_nocbs");
  write("proc/cmdline", "quiet rcu_nocbs=all\n");
  expect(what, Health::kNote, "without nohz_full:");
  write("sys/devices/system/cpu/isolated", "\n");
  expect(what, Health::kNote, "not isolated: anything may run");
}

TEST_F(Doctor, IsolatesNoProcessorThatTheKernelNeeds) {
  const std::string what = "the cycle's processor";
  cpu_ = 0;
  expect(what, Health::kNote, "processor 0, on which the kernel does its own work");
  EXPECT_EQ(finding(what).remedy,
            "choose another in [realtime] cpu of the service file, one that is isolated: 3");
  write("sys/devices/system/cpu/online", "0\n");
  write("sys/devices/system/cpu/isolated", "\n");
  EXPECT_NE(finding(what).remedy.find("this host has no other"), std::string::npos);
  EXPECT_EQ(finding(what).remedy.find("isolcpus"), std::string::npos) << finding(what).remedy;
}

TEST_F(Doctor, FindsWhatIsWrongWithClocksAndTimers) {
  EXPECT_EQ(finding("time of day").found, "synchronised, off by 4.0 ms at most");
  time_.is_synchronised = false;
  expect("time of day", Health::kNote, "not synchronised");
  write("sys/devices/system/clockevents/clockevent2/current_device", "hpet\n");
  expect("timer source", Health::kBad, "hpet for clockevent2");
  write("proc/sys/kernel/timer_migration", "1\n");
  expect("timer migration", Health::kNote, "on");
}

TEST_F(Doctor, MindsSleepStatesOnlyWhereNobodyMayHoldThemOff) {
  write("sys/devices/system/cpu/cpu0/cpuidle/state1/name", "C1\n");
  write("sys/devices/system/cpu/cpu0/cpuidle/state1/latency", "2\n");
  write("sys/devices/system/cpu/cpu0/cpuidle/state3/name", "C6\n");
  write("sys/devices/system/cpu/cpu0/cpuidle/state3/latency", "133\n");
  EXPECT_EQ(finding("sleep states").health, Health::kFine);
  rights_.has_dma_latency = false;
  expect("sleep states", Health::kNote, "C6, left in 133 us");
  write("sys/devices/system/cpu/cpu0/cpuidle/state3/disable", "1\n");
  EXPECT_EQ(finding("sleep states").health, Health::kFine);
}

TEST(Rights, AreTriedWithTheMemoryThatTheServiceMayUse) {
  EXPECT_EQ(static_cast<double>(kLockedMemory_mib), load_budget("resident_memory").allowed());
}

TEST_F(Doctor, FindsWhatIsWrongWithTheKernel) {
  write("proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC\n");
  expect("kernel", Health::kNote, "without PREEMPT_RT");
  write("sys/kernel/realtime", "1\n");
  EXPECT_EQ(finding("kernel").health, Health::kFine);
  write("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n");
  expect("clock source", Health::kBad, "hpet");
  write("proc/timer_list", "  .hres_active    : 0\n");
  expect("high-resolution timers", Health::kBad, "off");
  write("proc/swaps", "Filename Type Size\n/dev/sda2 partition 100\n");
  expect("swap", Health::kNote, "on");
  write("sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never\n");
  expect("transparent huge pages", Health::kNote, "always");
  write("proc/77/comm", "irqbalance\n");
  expect("interrupts", Health::kNote, "irqbalance");
}

TEST_F(Doctor, FindsWhatIsWrongWithTheNetwork) {
  write("proc/sys/net/core/rmem_max", "212992\n");
  expect("socket buffers", Health::kNote, "208 kB");
  write("sys/class/net/lo/operstate", "down\n");
  expect("DDS configuration", Health::kBad, "down");
}

TEST(DoctorOfPeers, FindsTwoServicesOfOneMachineAndOtherVersions) {
  dds::MachineInfo one;
  one.name = "mill";
  one.host = "here";
  one.service_version = "1";
  one.is_serving = true;
  EXPECT_TRUE(is_fit(examine_peers({}, "here", "1")));
  EXPECT_EQ(examine_peers({one}, "here", "1")[0].health, Health::kFine);
  EXPECT_EQ(examine_peers({one}, "here", "2")[0].health, Health::kNote);
  EXPECT_EQ(examine_peers({one}, "there", "1")[0].health, Health::kNote);
  const Findings two = examine_peers({one, one}, "here", "1");
  EXPECT_FALSE(is_fit(two));
  EXPECT_EQ(two.back().what, "machine mill");
}

TEST(DoctorOfPeers, ReportsItInJsonThatSaysWhetherTheHostIsFit) {
  const Findings findings{{"a \"b\"", Health::kBad, "c", "d"}};
  EXPECT_EQ(to_json(findings),
            "{\"fit\": false, \"findings\": [\n  {\"what\": \"a \\\"b\\\"\", \"health\": \"BAD\", "
            "\"found\": \"c\", \"remedy\": \"d\"}\n]}\n");
  EXPECT_NE(to_text(findings).find("NOT FIT for real time: 1 bad, 0 worth a note"),
            std::string::npos);
}

class DoctorOfTraces : public testing::Test {
 protected:
  [[nodiscard]] Finding examine(const fs::path& folder) const {
    const Findings all = examine_traces(folder);
    EXPECT_EQ(all.size(), 1U);
    return all.front();
  }
  void expect(const fs::path& folder, Health health, const std::string& found) const {
    const Finding one = examine(folder);
    EXPECT_EQ(one.health, health) << one.found;
    EXPECT_NE(one.found.find(found), std::string::npos) << one.found;
    EXPECT_EQ(one.remedy.empty(), health == Health::kFine) << one.remedy;
  }

  process::ScratchFolder folder_;
  fs::path traces_ = folder_.path() / "traces";
};

TEST_F(DoctorOfTraces, SaysHowToGetThemAndWhichOneToOpen) {
  expect("", Health::kFine, "meridiand --trace FOLDER");
  expect(traces_, Health::kFine, "the service makes " + traces_.string());
  EXPECT_FALSE(fs::exists(traces_)) << "nothing is changed";
  fs::create_directory(traces_);
  expect(traces_, Health::kFine, "none in " + traces_.string());
  for (const char* name : {"slow-700us-20260101T000000Z.json", "slow-5012us-20260102T000000Z.json",
                           "slow-9000us-20260102T000000Z.part", "notes.json"}) {
    std::ofstream(traces_ / name) << "{}";
  }
  expect(traces_, Health::kFine,
         "2 in " + traces_.string() +
             ", of the worst cycle slow-5012us-20260102T000000Z.json: "
             "open it in https://ui.perfetto.dev");
}

TEST_F(DoctorOfTraces, NotesAFolderThatCannotBeWritten) {
  std::ofstream(folder_.path() / "file") << "text";
  expect(folder_.path() / "file", Health::kNote, "file is no folder");
  expect(folder_.path() / "file" / "traces", Health::kNote, "file is no folder");
  expect("/proc/traces", Health::kNote, "/proc");
}

}  // namespace
}  // namespace meridian::probe
