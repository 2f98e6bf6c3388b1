// SPDX-License-Identifier: Apache-2.0
#include "service/ros/tip_topic.hpp"

#include <cmath>

#include "service/ros/message_types.hpp"
#include "service/ros/units.hpp"

namespace meridian::ros {

Quaternion from_z_to(const Vec3<double>& axis) noexcept {
  // Half of the angle between both: (z × axis, 1 + z · axis), normalised.
  const double w = 1 + axis[2];
  const double length = std::hypot(axis[0], axis[1], w);
  if (w < 1e-12 || length == 0) return {1, 0, 0, 0};
  return {-axis[1] / length, axis[0] / length, 0, w / length};
}

TipTopic::TipTopic(mcap::Writer& writer)
    : writer_(writer), channel_(add_topic(writer, "/tip", pose_stamped_type())) {}

void TipTopic::write(std::int64_t due_ns, const Pose<double>& pose) {
  if (!pace_.is_due(due_ns)) return;
  message_.begin().put_header(due_ns, "workpiece");
  for (const double value : pose.tip) message_.put(rounded(m_from_mm(value), kPositionPlaces));
  for (const double part : from_z_to(pose.axis)) message_.put(rounded(part, kPositionPlaces));
  (void)writer_.write(channel_, static_cast<std::uint64_t>(due_ns), message_.bytes());
}

}  // namespace meridian::ros
