// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/csv_file.hpp"
#include "service/recording/record/file/record_columns.hpp"
#include "service/recording/record/file/record_error.hpp"
#include "service/recording/record/flight/flight_row.hpp"

namespace meridian::record {

/// Writes what the flight recorder kept: a recording with the columns of RecordColumns, then
///
///     alarm,alarm_joint,feedback_cycle,feedback_age_ns,emergency_stop,<drive>_feedback_mm|_rad
///     ..., <drive>_statusword ...,<drive>_error ...
///
/// A drive that does not report keeps the values of its last report, with statusword 0; an age of
/// -1 means that no drive has reported yet. Context: I/O; one thread.
/// Proof: tests/unit/record/flight_test.cpp.
class FlightWriter {
 public:
  [[nodiscard]] static Expected<FlightWriter, RecordError> create(const std::string& path,
                                                                  const MachineModel& model);
  /// `alarm`: the one in force in that cycle.
  bool write(const FlightRow& row, const ReportedAlarm& alarm) noexcept;
  /// Flushes and closes; false where any row was lost.
  bool close() noexcept { return file_.close(); }
  [[nodiscard]] int error_number() const noexcept { return file_.error_number(); }

 private:
  FlightWriter(CsvFile file, const MachineModel& model)
      : file_(std::move(file)), columns_(model), model_(&model) {}

  CsvFile file_;
  RecordColumns columns_;
  const MachineModel* model_;  ///< of who made this
};

}  // namespace meridian::record
