// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "service/host/process/child_process.hpp"
#include "service/host/soak/chaos.hpp"
#include "service/host/soak/watch/evidence.hpp"
#include "service/machine/file/sections/service_file.hpp"

namespace meridian::soak {

/// What `meridian drives --inject` takes for a mishap of the drives; `drive_name` is whose it is
/// where it is of one drive. Proof: tests/unit/soak/soak_test.cpp.
[[nodiscard]] std::string injection_text(const Planned& mishap, const std::string& drive_name);

/// How the service of a plant is started.
struct PlantOptions {
  std::string machine{}, tools{};  ///< files; tools empty: none
  std::uint32_t domain = 0;
  config::RealtimeConfig realtime{.mode = config::RealtimeMode::kBestEffort};
  std::optional<int> bridge_cycles{};  ///< as the service file says
  std::filesystem::path trace{};       ///< folder of traces of slow cycles; empty: none
};

/// The service file of it: machine, tools, real time, and nothing else of a service that has its
/// own work to do. Proof: tests/unit/soak/soak_test.cpp.
[[nodiscard]] std::string service_text(const PlantOptions& options);

/// Service, drives and station as processes; each may die and be started again.
class Plant {
 public:
  /// Logs are kept in folder `kept`, anew; empty: none are.
  Plant(PlantOptions options, std::filesystem::path folder, const std::filesystem::path& kept);

  void start_service(const std::filesystem::path& recording);
  /// With something that is to go wrong, or nothing. `name` is that of the drive.
  void start_drives(const std::optional<Planned>& mishap, const std::string& drive_name);
  void start_station(const std::string& program);

  /// Ends it as an operator would; true where it ended well in time.
  bool end_service();
  void kill_service() { service_.reset(); }
  void kill_station() { station_.reset(); }

  /// Copies what service and drives said so far, at most kMaxKept times; returns where to, or
  /// "soak" where they were not kept.
  [[nodiscard]] std::string keep_logs();
  /// Copies what the flight recorder wrote of the fault whose logs were kept last, as
  /// NAMEn.flight.csv; the service has it ready about a second after the fault. Nothing where it
  /// wrote nothing. Proof: tests/unit/soak/evidence_test.cpp.
  void keep_flight();
  [[nodiscard]] bool awaits_flight() const { return !flight_of_.empty(); }

  [[nodiscard]] process::ChildProcess* service() { return service_.get(); }
  [[nodiscard]] process::ChildProcess* drives() { return drives_.get(); }
  [[nodiscard]] process::ChildProcess* station() { return station_.get(); }
  void stop_drives() { drives_.reset(); }

 private:
  [[nodiscard]] std::string log(const char* name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::filesystem::path flights() const { return folder_ / "flights"; }

  static constexpr int kMaxKept = 20;
  PlantOptions options_;
  std::string domain_;
  std::filesystem::path folder_;
  Evidence kept_;
  std::string flight_of_;  ///< stem of the logs whose flight is not kept yet
  std::filesystem::file_time_type logs_kept_;
  std::unique_ptr<process::ChildProcess> service_, drives_, station_;
};

}  // namespace meridian::soak
