// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/recorded/operator_events_writer.hpp"
#include "service/recording/record/file/recording_writer.hpp"

namespace meridian::telemetry {

/// The recording of record, written by a thread of its own: a slow or full disk loses rows, which
/// are counted, and nothing else. A service that is killed loses the last half second at most.
/// Links are not followed.
class Recorder {
 public:
  /// `path` empty: nothing is recorded. Throws std::runtime_error where the file cannot be made.
  Recorder(const std::string& path, const MachineModel& model);

  /// Telemetry thread: hands a row over. False: no room, the row is lost.
  [[nodiscard]] bool take(const CycleRecord& record) noexcept;
  /// Telemetry thread: accepted verbs and events of the planner go into a file of their own, for a
  /// replay. Where one is lost the file says so, and is not replayed.
  void take(const Event& event) noexcept;
  /// Telemetry thread: where the workpiece lies from a cycle on goes into the same file.
  void take(const record::RecordedFrame& frame) noexcept;
  /// Telemetry thread: so does a tool of the table that is in force from a cycle on.
  void take(const record::RecordedTool& tool) noexcept;
  /// Telemetry thread: so do soft limits that are in force from a cycle on.
  void take(const record::RecordedLimits& limits) noexcept;
  /// Telemetry thread: `count` events, ever, were lost before they came here. What they were nobody
  /// knows, so that the file of verbs counts as incomplete.
  void miss_events(std::uint64_t count) noexcept { events_missed_ = count; }
  /// Recorder's thread: writes until stop() and everything taken is on disk.
  void run() noexcept;
  void stop() noexcept { is_stopping_ = true; }

  [[nodiscard]] bool is_recording() const noexcept { return writer_.has_value(); }
  [[nodiscard]] std::uint64_t rows_lost() const noexcept { return rows_lost_; }
  [[nodiscard]] std::uint64_t events_lost() const noexcept { return events_lost_; }
  /// After run(): what the files lack, empty if nothing.
  [[nodiscard]] std::string complaint() const;

 private:
  std::optional<record::RecordingWriter> writer_;
  std::optional<record::OperatorEventsWriter> events_writer_;
  SpscRing<Event, 256> events_;
  SpscRing<record::RecordedFrame, 16> frames_;
  SpscRing<record::RecordedTool, 512> tools_;
  SpscRing<record::RecordedLimits, 64> limits_;
  SpscRing<CycleRecord, 8192> ring_;
  std::atomic<bool> is_stopping_{false};
  std::atomic<std::uint64_t> rows_lost_{0}, events_lost_{0}, events_missed_{0};
  std::string path_;
  int error_number_ = 0;  ///< of the first write that failed
};

}  // namespace meridian::telemetry
