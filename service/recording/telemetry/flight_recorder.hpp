// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/spdlog.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "service/recording/telemetry/flight_store.hpp"

namespace meridian::telemetry {

/// Where the faults of a machine go if nothing else is said: a folder of its own in `state`; none
/// where that is empty.
[[nodiscard]] std::filesystem::path default_fault_folder(const std::filesystem::path& state,
                                                         const std::string& machine);

/// Keeps the last seconds of what was sent and what drives reported, and writes them to files of
/// their own for every fault: `fault-TIME-ALARM.csv`, a recording (docs/recordings.md), and beside
/// it, in words, what happened, `.txt`. Files are written by a thread of its own: a slow or full
/// disk costs them, which the log reports, and nothing else.
/// Proof: tests/unit/telemetry/flight_recorder_test.cpp.
class FlightRecorder {
 public:
  /// An empty folder: nothing is kept. Else makes the folder; where it cannot be made or written
  /// to, the log says so and nothing is kept: that is no reason for a machine to stand. Of more
  /// seconds than 3 MiB hold the last that fit are kept, which is a warning.
  FlightRecorder(const config::FlightConfig& config, const MachineModel& model,
                 std::shared_ptr<spdlog::logger> log);

  /// Telemetry thread.
  void take(const record::DriveReport& report) noexcept { store_.take(report); }
  void take(const CycleRecord& record) noexcept { store_.take(record); }
  void take(const Event& event) noexcept;
  /// Telemetry thread, or nobody any more: nothing comes behind.
  void finish() noexcept { store_.finish(); }

  /// Telemetry thread, now and then: what was missed since is a warning in the log.
  void report_missed() noexcept;

  /// Recorder's thread: removes what a killed service left half written, then writes every fault
  /// until stop().
  void run() noexcept;
  void stop() noexcept { is_stopping_ = true; }

  [[nodiscard]] bool is_on() const noexcept { return !folder_.empty(); }
  /// A fault is on its way to the disk: nothing is kept meanwhile.
  [[nodiscard]] bool is_writing() const noexcept { return is_on() && store_.is_frozen(); }
  [[nodiscard]] std::size_t memory_bytes() const noexcept {
    return store_.room() * sizeof(record::FlightRow);
  }
  [[nodiscard]] std::uint64_t faults_missed() const noexcept { return store_.faults_missed(); }

 private:
  void write();
  [[nodiscard]] std::string write_rows(const std::filesystem::path& file) const;
  [[nodiscard]] std::string write_words(const std::filesystem::path& file,
                                        const std::string& when) const;
  void remove_torn() const;
  void remove_old(const std::filesystem::path& newest) const;

  std::filesystem::path folder_;
  std::size_t max_faults_;
  const MachineModel& model_;
  std::shared_ptr<spdlog::logger> log_;
  FlightStore store_;
  std::uint64_t reported_missed_ = 0;
  std::atomic<bool> is_stopping_{false};
};

}  // namespace meridian::telemetry
