// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/csv_file.hpp"
#include "service/recording/record/file/record_columns.hpp"
#include "service/recording/record/file/record_error.hpp"

namespace meridian::record {

/// Writes a recording: one row of RecordColumns per cycle sent (docs/recordings.md). Memory is
/// fixed after create(): rows gather in a buffer that goes to the file when it is full. A full disk
/// ends the recording and nothing else; what the destructor cannot write is lost, so call close()
/// where it matters. Context: I/O; one thread.
/// Proof: tests/unit/record/recording_test.cpp.
class RecordingWriter {
 public:
  /// Creates or empties the file and writes the header.
  [[nodiscard]] static Expected<RecordingWriter, RecordError> create(
      const std::string& path, const MachineModel& model, Links links = Links::kFollowed);
  /// Adds a row. False once a write failed (errno in error_number()); the row is dropped then.
  bool write(const CycleRecord& record) noexcept;
  /// Hands what is buffered to the system.
  bool flush() noexcept { return file_.flush(); }
  /// Flushes and closes; false where any row was lost.
  bool close() noexcept { return file_.close(); }

  [[nodiscard]] std::uint64_t row_count() const noexcept { return rows_; }
  [[nodiscard]] int error_number() const noexcept { return file_.error_number(); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  RecordingWriter(CsvFile file, const MachineModel& model)
      : file_(std::move(file)), columns_(model) {}

  CsvFile file_;
  RecordColumns columns_;
  std::uint64_t rows_ = 0;
};

}  // namespace meridian::record
