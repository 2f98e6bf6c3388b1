// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/wire_file.hpp"

#include <utility>

#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::ros {
namespace {

constexpr std::int64_t kLongestWait_ns = 1'000'000'000;

[[nodiscard]] record::RecordingRow row_of(const record::WireRow& seen, const MachineModel& model) {
  const Setpoint& setpoint = seen.setpoint;
  record::RecordingRow row;
  row.cycle = setpoint.cycle;
  row.due_ns = setpoint.due_ns;
  row.line = setpoint.line;
  row.epoch = setpoint.epoch;
  row.flags = setpoint.flags;
  row.joints = joints_of(model, setpoint.position);
  row.positions = limited_of(model, row.joints, setpoint.position);
  row.velocity =
      limited_of(model, joint_velocity_of(model, row.joints, setpoint.velocity), setpoint.velocity);
  row.feedback = seen.feedback;
  row.feedback_cycle = seen.feedback_cycle;
  row.feedback_age_ns = seen.feedback_ns == 0 ? -1 : seen.arrival_ns - seen.feedback_ns;
  row.statusword = seen.statusword;
  row.drive_error = seen.drive_error;
  row.is_emergency_stop = seen.is_emergency_stop;
  return row;
}

}  // namespace

Expected<std::unique_ptr<WireFile>, record::RecordError> WireFile::create(
    const std::string& path, const MachineModel& model) {
  const Contents contents{.has_state = false, .has_feedback = true, .has_statuswords = true};
  auto file = MotionFile::create(path, model, contents, "the wire");
  if (!file) return tl::make_unexpected(std::move(file.error()));
  return std::unique_ptr<WireFile>(new WireFile(std::move(*file), model));
}

void WireFile::add(const record::WireRow& seen) {
  if (!seen.is_intact || !MotionFile::has_time(seen.setpoint.due_ns)) {
    file_->write_event(now_ns_, Level::kWarning, "cycle",
                       "a setpoint of another service, or corrupted");
    return;
  }
  now_ns_ = seen.setpoint.due_ns;
  (void)file_->write(row_of(seen, model_));
  const bool is_anew = now_ns_ < chunk_ns_;
  if (!is_anew && now_ns_ - chunk_ns_ < kLongestWait_ns) return;
  chunk_ns_ = now_ns_;
  (void)file_->end_chunk();
}

void WireFile::add_status(State state, Alarm alarm, int joint) {
  if (state_ != state) {
    file_->write_event(now_ns_, level_of(state), "state", std::string(record::word(state)));
  }
  if (alarm_ != alarm) {
    std::string text(record::word(alarm));
    const bool has_joint = record::is_of_joint(alarm) && joint < limited_count(model_);
    if (has_joint) text += " of " + limited_spec(model_, joint).name;
    file_->write_event(now_ns_, alarm == Alarm::kNone ? Level::kInfo : Level::kError, "alarm",
                       text);
  }
  state_ = state;
  alarm_ = alarm;
}

}  // namespace meridian::ros
