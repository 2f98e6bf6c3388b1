// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/scene/link_frames.hpp"
#include "service/neighbours/ros/cdr.hpp"

/// Messages of ROS 2 that a file and the wire have alike. Each begins `message` anew.
/// Units: house units in, m, rad, s in the message. `time_ns`: not negative and below 2^31 s.
namespace meridian::ros {

/// sensor_msgs/JointState: the joints, then the drives of a stage. `velocity`: none where it is
/// not known. Proof: tests/unit/ros/motion_file_test.cpp.
void put_joint_state(Cdr& message, std::int64_t time_ns, const MachineModel& model,
                     const LimitedVector& position, const LimitedVector* velocity);

/// tf2_msgs/TFMessage. False, and no message, where a frame is not finite (drives where a stage has
/// no joints). Proof: tests/unit/ros/scene_topics_test.cpp.
[[nodiscard]] bool put_transforms(Cdr& message, std::int64_t time_ns,
                                  std::span<const scene::LinkFrame> frames);

}  // namespace meridian::ros
