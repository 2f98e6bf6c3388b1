// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/tip_topic.hpp"

#include "service/machine/scene/link_frames.hpp"
#include "service/neighbours/ros/message_types.hpp"
#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {

TipTopic::TipTopic(mcap::Writer& writer)
    : writer_(writer), channel_(add_topic(writer, "/tip", pose_stamped_type())) {}

void TipTopic::write(std::int64_t due_ns, const Pose<double>& pose) {
  if (!pace_.is_due(due_ns)) return;
  message_.begin().put_header(due_ns, "workpiece");
  for (const double value : pose.tip) message_.put(rounded(m_from_mm(value), kPositionPlaces));
  const Eigen::Quaterniond rotation = scene::from_z_to(pose.axis);  // outlives its coefficients
  for (const double part : rotation.coeffs()) message_.put(rounded(part, kPositionPlaces));
  (void)writer_.write(channel_, static_cast<std::uint64_t>(due_ns), message_.bytes());
}

}  // namespace meridian::ros
