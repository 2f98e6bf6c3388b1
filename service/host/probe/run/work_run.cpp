// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/work_run.hpp"

#include <signal.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "service/host/probe/run/bare_reference.hpp"
#include "service/host/probe/run/drive_side.hpp"
#include "service/host/probe/run/waiting.hpp"
#include "service/host/process/child_process.hpp"
#include "service/host/process/programs.hpp"
#include "service/text/whole_file.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"

namespace meridian::probe {
namespace {

namespace fs = std::filesystem;
using process::ChildProcess;
using std::chrono::milliseconds;
using Words = std::vector<std::string>;

/// A program whose words go to `log`, what it prints nowhere.
[[nodiscard]] ChildProcess::Options quiet(const fs::path& log) {
  return {.error_file = log.string(), .output_file = "/dev/null", .has_own_group = true};
}

/// Runs `meridian` as an operator does, until it is content.
class Tool {
 public:
  Tool(fs::path log, const std::atomic<bool>& is_stopping)
      : log_(std::move(log)), is_stopping_(is_stopping) {}

  /// With these words, to its end, `tries` times at most.
  void run(const Words& words, int tries = 1) const {
    Words all{process::program_beside("meridian").string()};
    all.insert(all.end(), words.begin(), words.end());
    for (int i = 0; i < tries; ++i) {
      ChildProcess tool(all, quiet(log_));
      if (wait_for_exit(tool, milliseconds(40'000), is_stopping_) == 0) return;
      std::this_thread::sleep_for(milliseconds(200));
    }
    throw std::runtime_error("meridian " + words.front() +
                             " failed: " + text::read_whole(log_).value_or(""));
  }

 private:
  fs::path log_;
  const std::atomic<bool>& is_stopping_;
};

/// The last error that the service has written to its log; empty: none.
[[nodiscard]] std::string last_error(const fs::path& log) {
  std::ifstream file(log);
  std::string found;
  for (std::string line; std::getline(file, line);) {
    if (const std::size_t at = line.find(" error "); at != std::string::npos) {
      found = line.substr(at + 7);
    }
  }
  return found;
}

[[nodiscard]] Histogram wake_of(dds::Reader<dds::Latency>& latencies) {
  Histogram wake;
  dds::Latency latency;
  while (latencies.take(latency)) {
    for (const dds::NamedHistogram& one : latency.histograms) {
      if (one.name == "publisher's wake") wake = one.histogram;
    }
  }
  return wake;
}

/// Enables, streams by a `station` that is left running, starts and waits; returns why the program
/// was not cut for `seconds`, if so.
[[nodiscard]] std::string cut(const ServiceSetup& setup, const std::string& part, double seconds,
                              const Tool& tool, std::unique_ptr<ChildProcess>& station,
                              const std::atomic<bool>& is_stopping) {
  const std::string in = std::to_string(setup.domain);
  const fs::path log = setup.folder / "station.log";
  try {
    tool.run({"ctl", "enable", "--domain", in, "--wait", "ready", "--wait-time", "20"}, 5);
    station = std::make_unique<ChildProcess>(Words{process::program_beside("meridian").string(),
                                                   "stream", part, "--domain", in, "--wait-end"},
                                             quiet(log));
    tool.run({"ctl", "start", "--domain", in}, 50);  // refused until the program is loaded
    const milliseconds timeout(std::llround(seconds * 1000));
    if (wait_for_exit(*station, timeout, is_stopping).value_or(0) != 0)
      return text::read_whole(log).value_or("");
  } catch (const Interrupted&) {
    throw;
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// Room for the setpoints of a whole run, its start and end included.
[[nodiscard]] std::size_t arrivals_of(const ServiceSetup& setup, double seconds) {
  constexpr double kAround_s = 120;  // several tries of the tool
  return static_cast<std::size_t>((seconds + kAround_s) * 1e9 /
                                  static_cast<double>(setup.period_ns));
}

}  // namespace

WorkResult run_work(const ServiceSetup& setup, double seconds,
                    const std::atomic<bool>& is_stopping) {
  const fs::path recording = setup.folder / "work.csv", log = setup.folder / "work.log";
  const std::string part = (setup.folder / "pattern.cl").string();
  const std::string in = std::to_string(setup.domain);
  const Tool tool(setup.folder / "tool.log", is_stopping);
  tool.run({"machine", setup.machine, "--pattern", part});
  ChildProcess service(setup.command(recording),
                       {.error_file = log.string(), .has_own_group = true});
  ChildProcess drives({process::program_beside("meridian").string(), "drives", "--machine",
                       setup.machine, "--domain", in, "--quiet"},
                      quiet(setup.folder / "drives.log"));
  DriveSide listener(setup.domain, setup.name, arrivals_of(setup, seconds),
                     DriveSide::Role::kListener);
  dds::Reader<dds::Latency> latencies(listener.participant());
  WorkResult result;
  std::unique_ptr<ChildProcess> station;
  result.broken_off = cut(setup, part, seconds, tool, station, is_stopping);
  if (const std::string why = last_error(log); !why.empty()) result.broken_off = why;
  std::this_thread::sleep_for(milliseconds(1100));  // latencies are published once a second
  result.wake = wake_of(latencies);
  service.send_signal(SIGTERM);
  if (service.wait_for_exit(milliseconds(12'000)) != 0) {
    throw std::runtime_error("meridiand: " + text::read_whole(log).value_or(""));
  }
  const auto times = read_times(recording, setup.period_ns);
  const auto arrivals = listener.arrivals();
  for (const Window& turn : moving_turns(times, setup.period_ns, kTurn_ns)) {
    add_turn(turn, setup.period_ns, times, arrivals, result.turns);
  }
  if (result.turns.moving == 0 && result.broken_off.empty()) {
    throw std::runtime_error("the program never ran: " + text::read_whole(log).value_or(""));
  }
  return result;
}

}  // namespace meridian::probe
