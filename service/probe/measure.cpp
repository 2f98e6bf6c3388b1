// SPDX-License-Identifier: Apache-2.0
#include "service/probe/measure.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "service/config/machine_file.hpp"
#include "service/probe/bare_reference.hpp"
#include "service/probe/cyclictest.hpp"
#include "service/probe/host_files.hpp"
#include "service/probe/load.hpp"
#include "service/probe/service_run.hpp"
#include "service/probe/work_run.hpp"
#include "service/process/processors.hpp"
#include "service/process/programs.hpp"

namespace meridian::probe {
namespace {

namespace fs = std::filesystem;

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
/// row of the recording, parsed), and until the end (samples of six kinds).
constexpr double kWorking_bytes = 320, kKept_bytes = 64;

struct Host {
  int cpu = 0;
  std::uint32_t domain = 0;
  std::string machine, name;  ///< file with the cycle to measure, name in it
};

void take_turns(const Host& host, std::int64_t period_ns, int turns, const fs::path& folder,
                RateMeasurement& m) {
  ServiceRun service(host.domain, folder, host.machine, host.name, period_ns, turns);
  if (!service.is_up()) throw std::runtime_error("the service does not send setpoints");
  service.pause();
  BareReference bare(host.cpu, host.domain, period_ns);
  for (int turn = 0; turn < turns; ++turn) {
    service.take_turn();
    const std::vector<std::int64_t> late_ns = bare.wake_turn();
    m.bare_wake.add(late_ns);
    m.bare_lost_periods += lost_periods(late_ns, period_ns);
    const BareReference::Pings pings = bare.ping_turn();
    m.bare_one_way.add(pings.one_way_ns);
    m.bare_round_trip.add(pings.round_trip_ns);
  }
  const ServiceRun::Result result = service.end();
  for (const auto& turn : result.lateness_ns) m.lateness.add(turn);
  for (const auto& turn : result.one_way_ns) m.one_way.add(turn);
  if (result.round_trip) m.round_trip = *result.round_trip;
  m.sent = result.sent;
  m.unseen = result.unseen;
  m.lost_periods = result.lost_periods;
}

[[nodiscard]] RateMeasurement measure_rate(const MeasureOptions& options, Host host, int rate_hz,
                                           bool is_loaded) {
  RateMeasurement m;
  m.rate_hz = rate_hz;
  m.is_loaded = is_loaded;
  const std::int64_t period_ns = 1'000'000 / rate_hz * 1000;  // whole microseconds, as in the file
  const process::ScratchFolder folder;
  host.machine = (folder.path() / "machine.toml").string();
  std::ifstream file(options.machine);
  std::ostringstream text;
  text << file.rdbuf();
  std::ofstream(host.machine) << with_cycle_us(text.str(), period_ns / 1000);
  host.name = config::load_machine(host.machine).name;
  const double stolen_before_ms = stolen_ms();
  std::unique_ptr<Load> load = is_loaded ? std::make_unique<Load>() : nullptr;
  take_turns(host, period_ns, options.turns, folder.path(), m);
  m.cyclictest = run_cyclictest(host.cpu, period_ns, options.turns);
  const WorkResult work =
      run_work(host.domain, folder.path(), host.machine, host.name, period_ns, options.turns);
  m.computation.add(work.computation_ns);
  m.wake = work.wake;
  m.broken_off = work.broken_off;
  load.reset();
  m.stolen_ms = stolen_ms() - stolen_before_ms;
  return m;
}

}  // namespace

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

std::vector<RateMeasurement> measure(const MeasureOptions& options,
                                     const std::function<void(const std::string&)>& say) {
  (void)config::load_machine(options.machine);  // refused before anything is started
  const Host host{process::last_cpu(), options.domain, "", ""};
  process::stay_off_cpu(host.cpu);
  std::vector<RateMeasurement> all;
  for (const bool is_loaded : {false, true}) {
    if (is_loaded && !options.has_load) continue;
    for (const int rate_hz : options.rates_hz) {
      say(std::to_string(rate_hz) + " Hz" + (is_loaded ? " under load" : "") + " ...");
      all.push_back(measure_rate(options, host, rate_hz, is_loaded));
    }
  }
  return all;
}

}  // namespace meridian::probe
