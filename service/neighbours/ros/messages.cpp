// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/messages.hpp"

#include <algorithm>

#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {

void put_joint_state(Cdr& message, std::int64_t time_ns, const MachineModel& model,
                     const LimitedVector& position, const LimitedVector* velocity) {
  const auto count = static_cast<std::size_t>(limited_count(model));
  const auto spec = [&](std::size_t i) -> const JointSpec& {
    return limited_spec(model, static_cast<int>(i));
  };
  message.begin().put_header(time_ns, "").put_count(count);
  for (std::size_t i = 0; i < count; ++i) message.put(spec(i).name);
  message.put_count(count);
  for (std::size_t i = 0; i < count; ++i) {
    message.put(rounded(in_ros_units(spec(i), position[i]), kPositionPlaces));
  }
  message.put_count(velocity != nullptr ? count : 0);
  for (std::size_t i = 0; i < count && velocity != nullptr; ++i) {
    message.put(rounded(in_ros_units(spec(i), (*velocity)[i]), kVelocityPlaces));
  }
  message.put_count(0);  // effort
}

bool put_transforms(Cdr& message, std::int64_t time_ns, std::span<const scene::LinkFrame> frames) {
  const bool is_finite = std::all_of(frames.begin(), frames.end(), [](const auto& frame) {
    return frame.pose.matrix().allFinite();
  });
  if (!is_finite) return false;
  message.begin().put_count(frames.size());
  for (const scene::LinkFrame& frame : frames) {
    message.put_header(time_ns, frame.parent).put(frame.name);
    for (const double value : frame.pose.translation()) {
      message.put(rounded(m_from_mm(value), kScreenPlaces));
    }
    const Eigen::Quaterniond rotation(frame.pose.linear());
    for (const double part : rotation.coeffs()) message.put(rounded(part, kScreenPlaces));
  }
  return true;
}

}  // namespace meridian::ros
