// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/event_rows.hpp"

#include <string>

#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::ros {

void EventRows::write(const record::RecordingRow& row) {
  write_cycle(row);
  write_machine(row);
  if (contents_.has_statuswords) write_drives(row);
  last_ = row;
  has_row_ = true;
}

void EventRows::write_cycle(const record::RecordingRow& row) {
  if (!has_row_) return;
  std::string text;
  if (row.cycle > last_.cycle + 1) {
    text::append(text, "%llu cycles missing", text::Count{row.cycle - last_.cycle - 1});
  } else if (row.cycle <= last_.cycle) {
    text = "cycles begin anew";
  }
  if (!text.empty()) topic_.write(row.due_ns, Level::kWarning, "cycle", text, row.line);
  if (row.epoch == last_.epoch) return;
  topic_.write(row.due_ns, Level::kInfo, "cycle", "epoch " + std::to_string(row.epoch), row.line);
}

void EventRows::write_machine(const record::RecordingRow& row) {
  if (contents_.has_state && (!has_row_ || row.state != last_.state)) {
    const Level level = level_of(row.state);
    topic_.write(row.due_ns, level, "state", record::word(row.state), row.line);
  }
  const bool had_stop = has_row_ && last_.is_emergency_stop;
  if (row.is_emergency_stop != had_stop) {
    topic_.write(row.due_ns, row.is_emergency_stop ? Level::kError : Level::kInfo, "drives",
                 row.is_emergency_stop ? "emergency stop" : "emergency stop over", row.line);
  }
  const Alarm before = has_row_ ? last_.alarm : Alarm::kNone;
  if (row.alarm == before) return;
  std::string text(record::word(row.alarm));
  if (row.alarm_joint >= 0) text += " of " + limited_spec(model_, row.alarm_joint).name;
  const Level level = row.alarm == Alarm::kNone ? Level::kInfo : Level::kError;
  topic_.write(row.due_ns, level, "alarm", text, row.line);
}

void EventRows::write_drives(const record::RecordingRow& row) {
  for (std::size_t i = 0; has_row_ && i < static_cast<std::size_t>(model_.joint_count); ++i) {
    const std::string_view now = record::drive_state_word(row.statusword[i]);
    const bool is_same_error = row.drive_error[i] == last_.drive_error[i];
    if (now == record::drive_state_word(last_.statusword[i]) && is_same_error) continue;
    std::string text = drive_spec(model_, static_cast<int>(i)).name + " " + std::string(now);
    if (row.drive_error[i] != 0) text::append(text, ", error %04Xh", row.drive_error[i]);
    const Level level = row.drive_error[i] != 0 ? Level::kError : Level::kInfo;
    topic_.write(row.due_ns, level, "drives", text, row.line);
  }
}

}  // namespace meridian::ros
