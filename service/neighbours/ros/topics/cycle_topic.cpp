// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/cycle_topic.hpp"

#include "meridian/kinematics/limited.hpp"
#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {
namespace {

[[nodiscard]] float seconds(std::int32_t ns) noexcept {
  return static_cast<float>(1e-9 * static_cast<double>(ns));
}

}  // namespace

CycleTopic::CycleTopic(mcap::Writer& writer, const MachineModel& model, const Contents& contents)
    : writer_(writer),
      model_(model),
      contents_(contents),
      channel_(add_topic(writer, "/cycle", cycle_type(model, contents))) {}

void CycleTopic::write(const record::RecordingRow& row, const DerivedRow& derived) {
  message_.begin().put_header(row.due_ns, "").put(row.cycle);
  put_positions(row, derived.pose());
  if (contents_.has_state) message_.put(row.sequence).put(rounded(row.plan_time_s, kTimePlaces));
  put_velocities(row, derived);
  if (contents_.has_state) {
    message_.put(static_cast<float>(row.rate));
    message_.put(seconds(row.lateness_ns)).put(seconds(row.computation_ns));
  }
  message_.put(row.line).put(row.epoch).put(row.flags);
  if (contents_.has_state) {
    message_.put(static_cast<std::uint8_t>(row.state)).put(static_cast<std::uint8_t>(row.kind));
  }
  if (contents_.has_alarm) message_.put(static_cast<std::uint8_t>(row.alarm));
  (void)writer_.write(channel_, static_cast<std::uint64_t>(row.due_ns), message_.bytes());
}

void CycleTopic::put_positions(const record::RecordingRow& row, const Pose<double>& pose) {
  for (int i = 0; i < limited_count(model_); ++i) {
    const double value = row.positions[static_cast<std::size_t>(i)];
    message_.put(rounded(in_ros_units(limited_spec(model_, i), value), kPositionPlaces));
  }
  for (const double value : pose.tip) message_.put(rounded(m_from_mm(value), kPositionPlaces));
  for (int i = 0; contents_.has_feedback && i < model_.joint_count; ++i) {
    const double value = row.feedback[static_cast<std::size_t>(i)];
    message_.put(rounded(in_ros_units(drive_spec(model_, i), value), kFeedbackPlaces));
  }
}

void CycleTopic::put_velocities(const record::RecordingRow& row, const DerivedRow& derived) {
  for (int i = 0; contents_.has_velocity && i < limited_count(model_); ++i) {
    const double value = row.velocity[static_cast<std::size_t>(i)];
    message_.put(rounded_float(in_ros_units(limited_spec(model_, i), value), kVelocityPlaces));
  }
  for (const double value : derived.pose().axis) message_.put(rounded_float(value, kAxisPlaces));
  message_.put(rounded_float(m_from_mm(derived.feed_mm_per_s()), kVelocityPlaces));
  message_.put(rounded_float(derived.turn_rad_per_s(), kVelocityPlaces));
}

}  // namespace meridian::ros
