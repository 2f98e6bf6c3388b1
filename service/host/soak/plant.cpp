// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/plant.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <system_error>
#include <utility>

#include "service/host/probe/run/service_setup.hpp"
#include "service/host/process/programs.hpp"
#include "service/text/printed.hpp"

namespace meridian::soak {
namespace {

using process::ChildProcess;
using std::chrono::milliseconds;

[[nodiscard]] const char* injection_word(Mishap mishap) {
  if (mishap == Mishap::kDriveFault) return "fault";
  if (mishap == Mishap::kDriveBlocked) return "blocked";
  return mishap == Mishap::kDrivesSilent ? "silence" : "emergency";
}

}  // namespace

std::string injection_text(const Planned& mishap, const std::string& drive_name) {
  std::string text = injection_word(mishap.mishap);
  text.append("@").append(std::to_string(mishap.at_s));
  if (is_of_drive(mishap.mishap)) text.append(":").append(drive_name);
  return text;
}

std::string service_text(const PlantOptions& options) {
  const auto quoted = [](const std::string& file) {
    return text::json_quoted(std::filesystem::absolute(file).string());
  };
  std::string out = "[service]\nmachine = " + quoted(options.machine) + "\n";
  if (!options.tools.empty()) out += "tools = " + quoted(options.tools) + "\n";
  if (options.bridge_cycles) {
    out += "bridge_cycles = " + std::to_string(*options.bridge_cycles) + "\n";
  }
  return out + "\n" + probe::realtime_section(options.realtime);
}

Plant::Plant(PlantOptions options, std::filesystem::path folder, const std::filesystem::path& kept)
    : options_(std::move(options)),
      domain_(std::to_string(options_.domain)),
      folder_(std::move(folder)),
      kept_(kept, "fault", kMaxKept) {}

void Plant::start_service(const std::filesystem::path& recording) {
  const auto file = folder_ / "service.toml";
  std::ofstream(file) << service_text(options_);
  std::vector<std::string> words{process::program_beside("meridiand").string(),
                                 "--service",
                                 file.string(),
                                 "--domain",
                                 domain_,
                                 "--record",
                                 recording.string(),
                                 "--faults",
                                 flights().string()};
  if (!options_.trace.empty()) words.insert(words.end(), {"--trace", options_.trace.string()});
  service_ = std::make_unique<ChildProcess>(
      words, ChildProcess::Options{.error_file = log("service.log"), .has_own_group = true});
}

void Plant::start_drives(const std::optional<Planned>& mishap, const std::string& drive_name) {
  std::vector<std::string> words{process::program_beside("meridian").string(),
                                 "drives",
                                 "--machine",
                                 options_.machine,
                                 "--domain",
                                 domain_};
  if (mishap) {
    words.insert(words.end(), {"--inject", injection_text(*mishap, drive_name)});
  }
  drives_.reset();
  drives_ =
      std::make_unique<ChildProcess>(words, ChildProcess::Options{.error_file = log("drives.log"),
                                                                  .output_file = log("drives.out"),
                                                                  .has_own_group = true});
}

void Plant::start_station(const std::string& program) {
  station_.reset();
  station_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{process::program_beside("meridian").string(), "stream", program,
                               "--domain", domain_, "--wait-end"},
      ChildProcess::Options{.error_file = log("station.log"),
                            .output_file = log("station.out"),
                            .has_own_group = true});
}

std::string Plant::keep_logs() {
  if (awaits_flight()) keep_flight();
  const std::string kept = kept_.keep({{log("service.log"), ".service.log"},
                                       {log("drives.out"), ".drives.out"},
                                       {log("drives.log"), ".drives.log"}});
  flight_of_ = kept;
  logs_kept_ = std::filesystem::file_time_type::clock::now();
  return kept.empty() ? "soak" : kept;
}

void Plant::keep_flight() {
  // The record of a stop may be on disk before the Fault that it ends in is reported.
  constexpr auto kStop = std::chrono::seconds(2);
  std::error_code error;
  std::filesystem::path newest;  // names begin with the time of the fault
  for (std::filesystem::directory_iterator at(flights(), error), end; !error && at != end;
       at.increment(error)) {
    std::error_code gone;
    const bool is_of_before = at->last_write_time(gone) < logs_kept_ - kStop;
    if (at->path().extension() == ".csv" && !is_of_before) newest = std::max(newest, at->path());
  }
  const std::string stem = std::exchange(flight_of_, "");
  if (!newest.empty()) std::filesystem::copy_file(newest, stem + ".flight.csv", error);
}

bool Plant::end_service() {
  if (!service_) return true;
  service_->send_signal(SIGTERM);
  const bool is_well = service_->wait_for_exit(milliseconds(15'000)) == 0;
  service_.reset();
  return is_well;
}

}  // namespace meridian::soak
