// SPDX-License-Identifier: Apache-2.0
#include "service/ros/joint_topic.hpp"

#include "meridian/kinematics/limited.hpp"
#include "service/ros/units.hpp"

namespace meridian::ros {

JointTopic::JointTopic(mcap::Writer& writer, const MachineModel& model, const Contents& contents)
    : writer_(writer),
      model_(model),
      contents_(contents),
      channel_(add_topic(writer, "/joint_states", joint_state_type())) {}

void JointTopic::write(const record::RecordingRow& row) {
  if (!pace_.is_due(row.due_ns)) return;
  const auto count = static_cast<std::size_t>(limited_count(model_));
  message_.begin().put_header(row.due_ns, "").put_count(count);
  for (std::size_t i = 0; i < count; ++i) {
    message_.put(limited_spec(model_, static_cast<int>(i)).name);
  }
  message_.put_count(count);
  for (std::size_t i = 0; i < count; ++i) {
    const JointSpec& spec = limited_spec(model_, static_cast<int>(i));
    message_.put(rounded(in_ros_units(spec, row.places[i]), kPositionPlaces));
  }
  message_.put_count(contents_.has_velocity ? count : 0);
  for (std::size_t i = 0; i < count && contents_.has_velocity; ++i) {
    const JointSpec& spec = limited_spec(model_, static_cast<int>(i));
    message_.put(rounded(in_ros_units(spec, row.velocity[i]), kVelocityPlaces));
  }
  message_.put_count(0);
  (void)writer_.write(channel_, static_cast<std::uint64_t>(row.due_ns), message_.bytes());
}

}  // namespace meridian::ros
