// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/transform_topic.hpp"

#include "service/neighbours/ros/message_types.hpp"
#include "service/neighbours/ros/messages.hpp"

namespace meridian::ros {

TransformTopic::TransformTopic(mcap::Writer& writer, const MachineModel& model)
    : writer_(writer),
      channel_(add_topic(writer, "/tf", transforms_type())),
      frames_(model),
      tool_length_mm_(model.tool_length_mm) {}

void TransformTopic::write(std::int64_t due_ns, const JointVector& joints) {
  if (!pace_.is_due(due_ns)) return;
  if (!put_transforms(message_, due_ns, frames_.at(joints, tool_length_mm_))) return;
  (void)writer_.write(channel_, static_cast<std::uint64_t>(due_ns), message_.bytes());
}

}  // namespace meridian::ros
