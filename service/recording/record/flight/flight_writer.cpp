// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/flight/flight_writer.hpp"

#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::record {

Expected<FlightWriter, RecordError> FlightWriter::create(const std::string& path,
                                                         const MachineModel& model) {
  auto file = CsvFile::create_anew(path);
  if (!file) return tl::make_unexpected(std::move(file.error()));
  std::string text = RecordColumns::header(model) +
                     ",alarm,alarm_joint,feedback_cycle,feedback_age_ns,emergency_stop";
  const auto add = [&](auto&& name_of_column) {
    for (int i = 0; i < model.joint_count; ++i) {
      text.append(",").append(name_of_column(drive_spec(model, i)));
    }
  };
  add(feedback_column);
  add(statusword_column);
  add(drive_error_column);
  (void)file->append(text += "\n");
  return FlightWriter(std::move(*file), model);
}

bool FlightWriter::write(const FlightRow& seen, const ReportedAlarm& alarm) noexcept {
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  const DriveReport& drives = seen.drives;
  const Setpoint& setpoint = seen.record.setpoint;
  const std::int64_t woke_ns = setpoint.due_ns + seen.record.lateness_ns;
  CsvRow row(at);
  columns_.put(row, seen.record);
  row.put(',').put(word(alarm.alarm)).put(',');
  row.put(is_of_joint(alarm.alarm) && alarm.joint >= 0 && alarm.joint < limited_count(*model_)
              ? std::string_view(limited_spec(*model_, alarm.joint).name)
              : std::string_view("none"));
  row.put(',').put_integer(drives.cycle_seen).put(',');
  row.put_integer(drives.arrival_ns == 0 ? -1 : woke_ns - drives.arrival_ns);
  row.put(',').put(drives.is_emergency_stop ? '1' : '0');
  const auto count = static_cast<std::size_t>(model_->joint_count);
  for (std::size_t i = 0; i < count; ++i) row.put(',').put_real(drives.position[i]);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_there = ((drives.joint_mask >> i) & 1U) != 0;
    row.put(',').put_integer(is_there ? drives.statusword[i] : std::uint16_t{0});
  }
  for (std::size_t i = 0; i < count; ++i) row.put(',').put_integer(drives.error[i]);
  file_.end_row(row.put('\n').end());
  return true;
}

}  // namespace meridian::record
