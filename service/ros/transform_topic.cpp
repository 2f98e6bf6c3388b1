// SPDX-License-Identifier: Apache-2.0
#include "service/ros/transform_topic.hpp"

#include "service/ros/message_types.hpp"
#include "service/ros/units.hpp"

namespace meridian::ros {

TransformTopic::TransformTopic(mcap::Writer& writer, const MachineModel& model)
    : writer_(writer),
      channel_(add_topic(writer, "/tf", transforms_type())),
      frames_(model),
      tool_length_mm_(model.tool_length_mm) {}

void TransformTopic::write(std::int64_t due_ns, const JointVector& joints) {
  if (!pace_.is_due(due_ns)) return;
  const auto& frames = frames_.at(joints, tool_length_mm_);
  message_.begin().put_count(frames.size());
  for (const scene::LinkFrame& frame : frames) {
    if (!frame.pose.matrix().allFinite()) return;  // drives where the stage has no joints
    message_.put_header(due_ns, frame.parent).put(frame.name);
    for (const double value : frame.pose.translation()) {
      message_.put(rounded(m_from_mm(value), kScreenPlaces));
    }
    const Eigen::Quaterniond rotation(frame.pose.linear());
    for (const double part : rotation.coeffs()) message_.put(rounded(part, kScreenPlaces));
  }
  (void)writer_.write(channel_, static_cast<std::uint64_t>(due_ns), message_.bytes());
}

}  // namespace meridian::ros
