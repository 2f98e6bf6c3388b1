// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/record_columns.hpp"

#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::record {

RecordColumns::RecordColumns(const MachineModel& model)
    : stage_(model.stage), joint_count_(model.joint_count), has_stage_(has_stage(model)) {}

std::string RecordColumns::header(const MachineModel& model) {
  std::string text = "cycle,due_ns,line,kind";
  for (int i = 0; i < limited_count(model); ++i) {
    text.append(",").append(position_column(limited_spec(model, i)));
  }
  for (int i = 0; i < limited_count(model); ++i) {
    text.append(",").append(velocity_column(limited_spec(model, i)));
  }
  return text + ",sequence,state,plan_time_s,rate,epoch,flags,lateness_ns,computation_ns";
}

void RecordColumns::put(CsvRow& row, const CycleRecord& record) const noexcept {
  const Setpoint& setpoint = record.setpoint;
  row.put_integer(setpoint.cycle).put(',').put_integer(setpoint.due_ns);
  row.put(',').put_integer(setpoint.line).put(',').put(word(record.motion));
  const auto put_positions = [&](const JointVector& joints, const JointVector& drives) {
    for (int i = 0; i < joint_count_; ++i) row.put(',').put_real(joints[i]);
    if (!has_stage_) return;
    row.put(',').put_real(drives[stage_.linear_joint]);
    row.put(',').put_real(drives[stage_.rotary_joint]);
  };
  put_positions(record.joints, setpoint.position);
  put_positions(stage::joint_velocity_of(stage_, record.joints, setpoint.velocity),
                setpoint.velocity);
  row.put(',').put_integer(record.sequence).put(',').put(word(record.state));
  row.put(',').put_real(record.plan_time_s).put(',').put_real(record.rate);
  row.put(',').put_integer(setpoint.epoch).put(',').put_integer(setpoint.flags);
  row.put(',').put_integer(record.lateness_ns).put(',').put_integer(record.computation_ns);
}

}  // namespace meridian::record
