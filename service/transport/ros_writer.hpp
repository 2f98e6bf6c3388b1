// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "service/transport/participant.hpp"

namespace meridian::dds {

/// Topics of ROS 2 with the names, types and quality of service that its own nodes publish with.
enum class RosTopic : std::uint8_t {
  kJointStates,       ///< rt/joint_states, sensor_msgs/JointState: reliable, keep last 10
  kTransforms,        ///< rt/tf, tf2_msgs/TFMessage: reliable, keep last 100
  kStaticTransforms,  ///< rt/tf_static, the same: reliable, transient local, keep last 1
  kRobotDescription,  ///< rt/robot_description, std_msgs/String: reliable, transient local, last 1
  kDiagnostics        ///< rt/diagnostics, diagnostic_msgs/DiagnosticArray: reliable, keep last 10
};

/// Writes messages of ROS 2, serialized by service/neighbours/ros. It waits for nobody: what a slow
/// reader has not acknowledged is lost to it alone. Proof: tests/ros/ros_bridge_test.cpp.
class RosWriter {
 public:
  /// `participant` has no machine: ROS 2 has no partitions. Throws DdsError.
  RosWriter(Participant& participant, RosTopic topic);
  ~RosWriter();
  RosWriter(const RosWriter&) = delete;
  RosWriter& operator=(const RosWriter&) = delete;

  /// `message`: CDR with its encapsulation. False where it does not fit the type, or DDS refuses.
  [[nodiscard]] bool write(std::string_view message) noexcept;
  [[nodiscard]] int matched_readers() const noexcept;
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

 private:
  std::int32_t topic_ = 0, writer_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace meridian::dds
