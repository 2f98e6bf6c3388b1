// SPDX-License-Identifier: Apache-2.0
#include "service/probe/work_run.hpp"

#include <signal.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "service/dds/messages.hpp"
#include "service/dds/reader.hpp"
#include "service/probe/service_run.hpp"
#include "service/process/child_process.hpp"
#include "service/process/programs.hpp"

namespace meridian::probe {
namespace {

namespace fs = std::filesystem;
using process::ChildProcess;
using std::chrono::milliseconds;
using Words = std::vector<std::string>;

[[nodiscard]] std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// `meridian` with these words, to its end, until it is content, `tries` times at most; what it
/// says goes to `log`.
void run_tool(const Words& words, const fs::path& log, int tries = 1) {
  Words all{process::program_beside("meridian").string()};
  all.insert(all.end(), words.begin(), words.end());
  for (int i = 0; i < tries; ++i) {
    ChildProcess tool(all, {.error_file = log.string(), .output_file = "/dev/null"});
    if (tool.wait_for_exit(milliseconds(40'000)) == 0) return;
    std::this_thread::sleep_for(milliseconds(200));
  }
  throw std::runtime_error("meridian " + words.front() + " failed: " + text_of(log));
}

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

}  // namespace

WorkResult run_work(std::uint32_t domain, const fs::path& folder, const std::string& machine,
                    const std::string& name, std::int64_t period_ns, double seconds) {
  const fs::path log = folder / "tool.log", recording = folder / "work.csv";
  const std::string part = (folder / "pattern.cl").string(), in = std::to_string(domain);
  const std::string meridian = process::program_beside("meridian").string();
  run_tool({"machine", machine, "--pattern", part}, log);
  ChildProcess service({process::program_beside("meridiand").string(), "--machine", machine,
                        "--domain", in, "--record", recording.string(), "--best-effort"},
                       {.error_file = (folder / "work.log").string()});
  ChildProcess drives({meridian, "drives", "--machine", machine, "--domain", in, "--quiet"},
                      {.error_file = (folder / "drives.log").string(), .output_file = "/dev/null"});
  dds::Participant participant({.domain = domain, .machine = name});
  dds::Reader<dds::Latency> latencies(participant);
  WorkResult result;
  std::unique_ptr<ChildProcess> station;
  try {
    run_tool({"ctl", "enable", "--domain", in, "--wait", "ready", "--wait-time", "20"}, log, 5);
    station = std::make_unique<ChildProcess>(
        Words{meridian, "stream", part, "--domain", in, "--wait-end"},
        ChildProcess::Options{.error_file = (folder / "station.log").string(),
                              .output_file = "/dev/null"});
    run_tool({"ctl", "start", "--domain", in}, log, 50);  // refused until the program is loaded
    const auto code = station->wait_for_exit(milliseconds(std::llround(seconds * 1000)));
    if (code.value_or(0) != 0) result.broken_off = text_of(folder / "station.log");
  } catch (const std::runtime_error& error) {
    result.broken_off = error.what();
  }
  if (const std::string why = last_error(folder / "work.log"); !why.empty()) {
    result.broken_off = why;
  }
  std::this_thread::sleep_for(milliseconds(1100));  // latencies are told once a second
  result.wake = wake_of(latencies);
  service.send_signal(SIGTERM);
  if (service.wait_for_exit(milliseconds(12'000)) != 0) {
    throw std::runtime_error("meridiand: " + text_of(folder / "work.log"));
  }
  for (const auto& [cycle, time] : read_times(recording, period_ns)) {
    if (!time.is_moving) continue;
    if (time.computation_ns >= 0) result.computation_ns.push_back(time.computation_ns);
    result.lost_periods += time.lost;
  }
  if (result.computation_ns.empty() && result.broken_off.empty()) {
    throw std::runtime_error("the program never ran: " + text_of(folder / "work.log"));
  }
  return result;
}

}  // namespace meridian::probe
