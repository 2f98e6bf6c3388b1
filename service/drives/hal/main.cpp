// SPDX-License-Identifier: Apache-2.0
// meridian-hal: the joints of LinuxCNC's HAL as the drives of a machine. It speaks DDS with the
// service, and shared memory with the component `meridian_hal`; docs/linuxcnc.md.
#include <sys/mman.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "meridian/drive.hpp"
#include "service/drives/hal/hal_hardware.hpp"
#include "service/drives/hal/hal_memory.hpp"
#include "service/drives/hal/homing_option.hpp"
#include "service/drives/kit/pace.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::hal {
namespace {

std::atomic<bool> is_stopping{false};

void say(const std::string& text) {
  std::puts(text.c_str());
  std::fflush(stdout);
}

/// For how long HAL goes on without a setpoint: what the machine file says; in best effort 50 ms,
/// as the service has it.
[[nodiscard]] std::int64_t bridge_of(const MachineModel& model, double asked_ms) {
  constexpr std::int64_t kBestEffort_ns = 50'000'000;
  if (asked_ms > 0) return static_cast<std::int64_t>(1e6 * asked_ms);
  const std::int64_t of_machine = model.bridge_cycles * model.cycle_ns;
  if (drive::may_have_priority(1)) return of_machine;
  say("no right to threads of real-time class: HAL bridges 50 ms without a setpoint");
  return std::max(of_machine, kBestEffort_ns);
}

/// What is wrong with a bridge; empty: nothing.
[[nodiscard]] std::string check_bridge(const std::string& text) {
  double value = 0;
  const bool is_number = CLI::detail::lexical_cast(text, value);
  return is_number && value >= 0 && value <= 100 ? "" : "must be from 0 to 100";
}

[[nodiscard]] bool wait_for_hal(HalHardware& hardware, const std::string& machine) {
  if (!hardware.hear(drive::monotonic_ns())) {
    say("waiting for HAL: loadrt meridian_hal machine=" + machine + ", addf meridian.update");
  }
  while (!is_stopping && !hardware.hear(drive::monotonic_ns())) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return !is_stopping;
}

int run(drive::Options options, const std::vector<std::string>& homing, double bridge_ms) {
  const MachineModel model = config::load_machine(options.machine_file);
  options.machine = model.name;
  options.cycle_ns = model.cycle_ns;
  options.axes = drive::axes_of(options.machine_file);
  for (const std::string& option : homing) set_homing(options.axes, option);
  const HalMemory memory(options.machine);
  HalHardware hardware(memory.get(), options.axes, model.cycle_ns, bridge_of(model, bridge_ms));
  if (!wait_for_hal(hardware, options.machine)) return 0;
  options.act = [&](const drive::Action& action) { return hardware.act(action, is_stopping); };
  options.report = say;
  (void)::mlockall(MCL_CURRENT);
  drive::Drives drives(options, hardware);
  say("drives of machine " + options.machine + " are those of HAL");
  drives.run([&] {
    for (int i = 0; i < drives.axis_count(); ++i) {
      hardware.set_referenced(i, drives.status(i).is_referenced);
    }
    return is_stopping.load(std::memory_order_relaxed);
  });
  return 0;
}

}  // namespace
}  // namespace meridian::hal

int main(int count, char** arguments) {
  CLI::App app("The joints of LinuxCNC's HAL as the drives of a machine");
  meridian::drive::Options options;
  std::vector<std::string> homing;
  double bridge_ms = 0;
  app.add_option("machine", options.machine_file, "Machine file (TOML)")->required();
  app.add_option("--domain", options.domain, "DDS domain")
      ->envname("MERIDIAN_DOMAIN")
      ->capture_default_str()
      ->check(CLI::Range(0, 230));
  app.add_option("--group", options.group, "Number of these drives, where there are others too");
  app.add_option("--homing", homing, "NAME=hal, or NAME=index:VELOCITY:POSITION:DISTANCE");
  app.add_option("--bridge-ms", bridge_ms,
                 "HAL goes on for so long without a setpoint; 0: as the machine file says, 50 "
                 "without the right to real-time threads")
      ->check(CLI::Validator(
          [](const std::string& text) { return meridian::hal::check_bridge(text); }, "0 to 100"));
  app.add_flag("--open-network", options.may_leave_host,
               "Start though CYCLONEDDS_URI leads off this host without an identity");
  CLI11_PARSE(app, count, arguments);
  for (const int end : {SIGINT, SIGTERM}) {
    std::signal(end, [](int) { meridian::hal::is_stopping = true; });
  }
  try {
    meridian::drive::leave_last_processor();
    return meridian::hal::run(options, homing, bridge_ms);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "meridian-hal: %s\n", error.what());
    return 3;
  }
}
