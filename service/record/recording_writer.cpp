// SPDX-License-Identifier: Apache-2.0
#include "service/record/recording_writer.hpp"

#include "service/record/words.hpp"

namespace meridian::record {
namespace {

[[nodiscard]] std::string header(const MachineModel& model) {
  std::string text = "cycle,due_ns,line,kind";
  for (int i = 0; i < limited_count(model); ++i) {
    text.append(",").append(position_column(limited_spec(model, i)));
  }
  for (int i = 0; i < limited_count(model); ++i) {
    text.append(",").append(velocity_column(limited_spec(model, i)));
  }
  text += ",sequence,state,plan_time_s,rate,epoch,flags,lateness_ns,computation_ns\n";
  return text;
}

}  // namespace

Expected<RecordingWriter, RecordError> RecordingWriter::create(const std::string& path,
                                                               const MachineModel& model) {
  auto file = CsvFile::create(path);
  if (!file) return tl::make_unexpected(std::move(file.error()));
  (void)file->append(header(model));
  return RecordingWriter(std::move(*file), model);
}

bool RecordingWriter::write(const CycleRecord& record) noexcept {
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  const Setpoint& setpoint = record.setpoint;
  CsvRow row(at);
  row.put_integer(setpoint.cycle).put(',').put_integer(setpoint.due_ns);
  row.put(',').put_integer(setpoint.line).put(',').put(word(record.motion));
  const auto put = [&](const JointVector& joints, const JointVector& drives) {
    for (int i = 0; i < joint_count_; ++i) row.put(',').put_real(joints[i]);
    if (!has_stage_) return;
    row.put(',').put_real(drives[stage_.linear_joint]);
    row.put(',').put_real(drives[stage_.rotary_joint]);
  };
  put(record.joints, setpoint.position);
  put(stage::joint_velocity_of(stage_, record.joints, setpoint.velocity), setpoint.velocity);
  row.put(',').put_integer(record.sequence).put(',').put(word(record.state));
  row.put(',').put_real(record.plan_time_s).put(',').put_real(record.rate);
  row.put(',').put_integer(setpoint.epoch).put(',').put_integer(setpoint.flags);
  row.put(',').put_integer(record.lateness_ns).put(',').put_integer(record.computation_ns);
  file_.end_row(row.put('\n').end());
  ++rows_;
  return true;
}

}  // namespace meridian::record
