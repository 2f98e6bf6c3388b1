// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/drives_topic.hpp"

#include <cmath>

#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {

DrivesTopic::DrivesTopic(mcap::Writer& writer, const MachineModel& model, const Contents& contents)
    : writer_(writer),
      model_(model),
      contents_(contents),
      channel_(add_topic(writer, "/drives", drives_type(model, contents))),
      pace_(contents.has_alarm ? 0 : kScreenPeriod_ns) {}

void DrivesTopic::write(const record::RecordingRow& row) {
  const auto count = static_cast<std::size_t>(model_.joint_count);
  sent_.note(row, model_);
  const JointVector* const seen = sent_.seen_by(row);
  for (std::size_t i = 0; seen != nullptr && i < count; ++i) {
    const double error = row.feedback[i] - (*seen)[i];
    if (!(std::abs(error) <= std::abs(worst_[i]))) worst_[i] = error;
  }
  if (!pace_.is_due(row.due_ns)) return;
  message_.begin().put_header(row.due_ns, "").put(row.feedback_cycle);
  if (contents_.has_statuswords) {
    const bool has_report = row.feedback_age_ns >= 0;
    message_.put(has_report ? 1e-9 * static_cast<double>(row.feedback_age_ns) : -1.0);
    message_.put(row.is_emergency_stop);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const JointSpec& spec = drive_spec(model_, static_cast<int>(i));
    message_.put(rounded_float(in_ros_units(spec, worst_[i]), kFeedbackPlaces));
    if (!contents_.has_statuswords) continue;
    message_.put(row.statusword[i]).put(row.drive_error[i]);
  }
  worst_ = {};
  (void)writer_.write(channel_, static_cast<std::uint64_t>(row.due_ns), message_.bytes());
}

}  // namespace meridian::ros
