// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/joint_topic.hpp"

#include "service/neighbours/ros/messages.hpp"

namespace meridian::ros {

JointTopic::JointTopic(mcap::Writer& writer, const MachineModel& model, const Contents& contents)
    : writer_(writer),
      model_(model),
      contents_(contents),
      channel_(add_topic(writer, "/joint_states", joint_state_type())) {}

void JointTopic::write(const record::RecordingRow& row) {
  if (!pace_.is_due(row.due_ns)) return;
  put_joint_state(message_, row.due_ns, model_, row.positions,
                  contents_.has_velocity ? &row.velocity : nullptr);
  (void)writer_.write(channel_, static_cast<std::uint64_t>(row.due_ns), message_.bytes());
}

}  // namespace meridian::ros
