// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/csv_file.hpp"

namespace meridian::record {

/// The columns of what a cycle sent, as every file of records has them (docs/recordings.md):
///
///     cycle,due_ns,line,kind,<joint>_mm|_rad ...,<joint>_mm_per_s|_rad_per_s ...,
///     sequence,state,plan_time_s,rate,epoch,flags,lateness_ns,computation_ns
///
/// Behind the joints come the drives of an actuator stage, where the machine has one. Numbers carry
/// 17 significant digits, so that a reader gets the very same doubles.
/// Proof: tests/unit/record/recording_test.cpp.
class RecordColumns {
 public:
  explicit RecordColumns(const MachineModel& model);

  /// Their names, without the end of the line.
  [[nodiscard]] static std::string header(const MachineModel& model);
  void put(CsvRow& row, const CycleRecord& record) const noexcept;

 private:
  ActuatorStage stage_;
  int joint_count_;
  bool has_stage_;
};

}  // namespace meridian::record
