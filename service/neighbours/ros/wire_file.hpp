// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/ros/motion_file.hpp"
#include "service/recording/record/file/record_error.hpp"
#include "service/recording/record/file/wire_recording.hpp"

namespace meridian::ros {

/// What somebody on the wire saw as an MCAP file, while it is seen: the topics of MotionFile, and
/// of the status the states and alarms. Every second of motion goes to the system, so that a killed
/// process loses one. Setpoints that are damaged, or of another service, are an event and no row.
/// Context: I/O; one thread. Proof: tests/unit/ros/wire_file_test.cpp.
class WireFile {
 public:
  /// Creates or empties the file. `model` must live on.
  [[nodiscard]] static Expected<std::unique_ptr<WireFile>, record::RecordError> create(
      const std::string& path, const MachineModel& model);

  void add(const record::WireRow& seen);
  /// What the newest status says; told where it is other than before. `joint`: place in
  /// limited.hpp.
  void add_status(State state, Alarm alarm, int joint);
  [[nodiscard]] std::optional<record::RecordError> close() { return file_->close(); }

 private:
  WireFile(std::unique_ptr<MotionFile> file, const MachineModel& model)
      : file_(std::move(file)), model_(model) {}

  std::unique_ptr<MotionFile> file_;
  const MachineModel& model_;
  std::int64_t now_ns_ = 0;    ///< of the newest row
  std::int64_t chunk_ns_ = 0;  ///< of the first row that waits
  std::optional<State> state_;
  Alarm alarm_ = Alarm::kNone;
};

}  // namespace meridian::ros
