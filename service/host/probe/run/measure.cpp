// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/measure.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <stdexcept>

#include "service/host/probe/doctor/host_files.hpp"
#include "service/host/probe/run/bare_reference.hpp"
#include "service/host/probe/run/cyclictest.hpp"
#include "service/host/probe/run/load.hpp"
#include "service/host/probe/run/service_run.hpp"
#include "service/host/probe/run/service_setup.hpp"
#include "service/host/probe/run/waiting.hpp"
#include "service/host/probe/run/work_run.hpp"
#include "service/host/process/processors.hpp"
#include "service/host/process/programs.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::probe {
namespace {

/// Time that the host of a virtual machine gave to others, all processors, ms (proc(5), stat).
[[nodiscard]] double stolen_ms() {
  std::ifstream file("/proc/stat");
  std::string name;
  double ticks = 0;
  file >> name;
  for (int i = 0; i < 8; ++i) file >> ticks;
  return 1000 * ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

[[nodiscard]] std::uint64_t lost_periods(const std::vector<std::int64_t>& late_ns,
                                         std::int64_t period_ns) {
  std::uint64_t lost = 0;
  for (const std::int64_t late : late_ns) {
    lost += late > 0 ? static_cast<std::uint64_t>(late / period_ns) : 0;
  }
  return lost;
}

/// Of each cycle of a turn: while it is measured (arrivals, twice, those between the turns too; a
/// row of the recording, parsed), and until the end (samples of eight kinds).
constexpr double kWorking_bytes = 320, kKept_bytes = 80;

void add_turns(Turns& to, const std::vector<std::vector<std::int64_t>>& turns,
               std::int64_t interval_ns = 0) {
  for (const auto& turn : turns) to.add(turn, interval_ns);
}

/// The service while it cuts.
void cut(const ServiceSetup& setup, int seconds, const std::atomic<bool>& is_stopping,
         RateMeasurement& m) {
  const WorkResult work = run_work(setup, seconds, is_stopping);
  add_turns(m.cutting_lateness, work.turns.lateness_ns, setup.period_ns);
  add_turns(m.cutting_one_way, work.turns.one_way_ns);
  m.computation.add(work.turns.computation_ns);
  m.moving = work.turns.moving;
  m.cutting_lost = work.turns.periods;
  m.cutting_unseen = work.turns.setpoints;
  m.untimed += work.turns.untimed;
  m.wake = work.wake;
  m.broken_off = work.broken_off;
}

[[nodiscard]] RateMeasurement measure_rate(const MeasureOptions& options, int rate_hz,
                                           bool is_loaded, const std::atomic<bool>& is_stopping) {
  RateMeasurement m;
  m.rate_hz = rate_hz;
  m.is_loaded = is_loaded;
  const process::ScratchFolder folder;
  ServiceSetup setup{.domain = options.domain,
                     .folder = folder.path(),
                     .machine = (folder.path() / "machine.toml").string(),
                     .period_ns = 1'000'000 / rate_hz * 1000,  // whole microseconds, as in the file
                     .realtime = options.realtime};
  std::ofstream(setup.machine) << with_cycle_us(text::read_whole(options.machine).value_or(""),
                                                setup.period_ns / 1000);
  setup.name = config::load_machine(setup.machine).name;
  const double stolen_before_ms = stolen_ms();
  try {
    const std::unique_ptr<Load> load = is_loaded ? std::make_unique<Load>() : nullptr;
    take_turns(setup, options.turns, is_stopping, m);
    m.cyclictest = run_cyclictest(setup.realtime.cpu, setup.period_ns, options.turns, is_stopping);
    cut(setup, options.turns, is_stopping, m);
  } catch (const Interrupted&) {
    m.is_interrupted = true;
  } catch (const std::exception& error) {
    if (m.periods == 0) throw;
    m.broken_off = error.what();  // what the turns came to is reported
  }
  m.stolen_ms = stolen_ms() - stolen_before_ms;
  return m;
}

}  // namespace

void take_turns(const ServiceSetup& setup, int turns, const std::atomic<bool>& is_stopping,
                RateMeasurement& m) {
  ServiceRun service(setup, turns);
  if (!service.is_up()) throw std::runtime_error("the service does not send setpoints");
  service.pause();
  BareReference bare(setup.realtime.cpu, setup.domain, setup.period_ns,
                     setup.realtime.cycle_priority);
  for (int turn = 0; turn < turns && !is_stopping.load(); ++turn) {
    service.take_turn();
    const std::vector<std::int64_t> late_ns = bare.wake_turn();
    m.bare_wake.add(late_ns, setup.period_ns);
    const std::uint64_t lost = lost_periods(late_ns, setup.period_ns);
    m.bare_lost += {lost, late_ns.size() + lost};
    const BareReference::Pings pings = bare.ping_turn();
    m.bare_one_way.add(pings.one_way_ns);
    m.bare_round_trip.add(pings.round_trip_ns);
    m.bare_unseen += pings.unseen;
  }
  const ServiceRun::Result result = service.end();
  add_turns(m.lateness, result.turns.lateness_ns, setup.period_ns);
  add_turns(m.one_way, result.turns.one_way_ns);
  if (result.round_trip) m.round_trip = *result.round_trip;
  m.lost = result.turns.periods;
  m.unseen = result.turns.setpoints;
  m.untimed += result.turns.untimed;
  m.periods = result.turns.periods.of;
}

double available_mib() {
  const auto text = HostFiles().text("proc/meminfo").value_or("");
  const std::size_t at = text.find("MemAvailable:");
  constexpr double kKib_per_mib = 1024;
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + 13, nullptr) / kKib_per_mib;
}

std::string too_large(const MeasureOptions& options, double available_mib) {
  double fastest = 0, all = 0;
  for (const int rate_hz : options.rates_hz) {
    fastest = std::max(fastest, static_cast<double>(rate_hz));
    all += rate_hz * (options.has_load ? 2 : 1);
  }
  const double needed_per_s_mib = (fastest * kWorking_bytes + all * kKept_bytes) / (1024 * 1024);
  const double room_mib = available_mib / 2;
  if (needed_per_s_mib * options.turns <= room_mib) return "";
  return std::to_string(options.turns) + " s at these rates would take " +
         std::to_string(std::lround(needed_per_s_mib * options.turns)) + " MiB of memory; " +
         std::to_string(std::lround(std::floor(room_mib / needed_per_s_mib))) +
         " s are what this host has room for: measure for less long or at fewer --rates; "
         "`meridian soak --for 8h` is the measurement for long";
}

std::string with_cycle_us(const std::string& machine_text, std::int64_t cycle_us) {
  static const std::regex kCycle(R"((^|\n)(\s*cycle_us\s*=\s*)[0-9_]+)");
  if (!std::regex_search(machine_text, kCycle)) {
    throw std::runtime_error("the machine file names no cycle_us");
  }
  return std::regex_replace(machine_text, kCycle, "$1$02" + std::to_string(cycle_us),
                            std::regex_constants::format_first_only);
}

int cycle_cpu(const config::RealtimeConfig& realtime) {
  if (realtime.cpu < 0) return process::last_cpu();
  if (process::take_cpu(realtime.cpu)) return realtime.cpu;
  throw std::runtime_error("processor " + std::to_string(realtime.cpu) +
                           " is not one that this process may use: it is not there, or a control "
                           "group (cpuset) keeps it; see AllowedCPUs= of the unit, or choose "
                           "another by --cpu");
}

void measure(const MeasureOptions& options, const std::atomic<bool>& is_stopping,
             const Audience& audience) {
  (void)config::load_machine(options.machine);  // refused before anything is started
  MeasureOptions here = options;
  here.realtime.cpu = cycle_cpu(options.realtime);
  process::stay_off_cpu(here.realtime.cpu);
  for (const bool is_loaded : {false, true}) {
    if (is_loaded && !options.has_load) continue;
    for (const int rate_hz : options.rates_hz) {
      if (is_stopping.load()) return;
      audience.say(std::to_string(rate_hz) + " Hz" + (is_loaded ? " under load" : "") + " ...");
      audience.take(measure_rate(here, rate_hz, is_loaded, is_stopping));
    }
  }
}

}  // namespace meridian::probe
