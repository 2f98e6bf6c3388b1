// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/rt/cycle_data.hpp"
#include "service/record/record_error.hpp"

namespace meridian::record {

/// Writes a recording: one row per cycle sent (docs/recordings.md).
///
///     cycle,due_ns,line,kind,<joint>_mm|_rad ...,<joint>_mm_per_s|_rad_per_s ...,
///     sequence,state,plan_time_s,rate,epoch,flags,lateness_ns,computation_ns
///
/// Numbers carry 17 significant digits, so that a reader gets the very same doubles. Memory is
/// fixed after create(): rows gather in a buffer that goes to the file when it is full. A full disk
/// ends the recording and nothing else. Context: I/O; one thread.
/// Proof: tests/unit/record/recording_test.cpp.
class RecordingWriter {
 public:
  /// Creates or empties the file and writes the header.
  [[nodiscard]] static Expected<RecordingWriter, RecordError> create(const std::string& path,
                                                                     const MachineModel& model);
  /// Writes what is buffered; a failure is lost here, so call close() where it matters.
  ~RecordingWriter();
  RecordingWriter(RecordingWriter&& other) noexcept;
  RecordingWriter& operator=(RecordingWriter&& other) noexcept;
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// Adds a row. False once a write failed (errno in error_number()); the row is dropped then.
  bool write(const CycleRecord& record) noexcept;
  /// Hands what is buffered to the system.
  bool flush() noexcept;
  /// Flushes and closes; false where any row was lost.
  bool close() noexcept;

  [[nodiscard]] std::uint64_t row_count() const noexcept { return rows_; }
  [[nodiscard]] int error_number() const noexcept { return error_number_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  RecordingWriter(int file, std::string path, int joint_count);

  std::string path_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
  std::uint64_t rows_ = 0;
  int file_ = -1;
  int error_number_ = 0;
  int joint_count_ = 0;
};

}  // namespace meridian::record
