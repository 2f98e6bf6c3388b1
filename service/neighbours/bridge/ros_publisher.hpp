// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/scene/link_frames.hpp"
#include "service/neighbours/bridge/diagnostics.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/transport/ros_writer.hpp"

namespace meridian::bridge {

struct RosCounts {
  std::uint64_t joint_states = 0, transforms = 0, descriptions = 0, diagnostics = 0;
  std::uint64_t refused = 0;  ///< by DDS
};

/// A machine on the topics of ROS 2: joint states, frames, description, diagnostics. It publishes
/// and reads nothing. Units: mm, rad, s in; m, rad, s on the wire. Context: I/O, one thread.
/// Proof: tests/ros/ros_bridge_test.cpp, by readers of Fast DDS.
class RosPublisher {
 public:
  /// Describes the machine. `participant` has no machine (RosWriter). Throws dds::DdsError.
  RosPublisher(dds::Participant& participant, const MachineModel& model, std::int64_t time_ns);

  /// Describes the machine anew: another work frame, another tool.
  void describe(const MachineModel& model, std::int64_t time_ns);
  /// Where the joints are, and how fast where that is known; drives of a stage follow from them.
  void publish_joints(std::int64_t time_ns, const JointVector& joints,
                      const std::optional<JointVector>& velocity);
  void publish_diagnostics(std::int64_t time_ns, const std::vector<Diagnosis>& all);

  [[nodiscard]] const MachineModel& model() const noexcept { return model_; }
  /// Who reads the joint states.
  [[nodiscard]] int joint_state_readers() const noexcept { return joint_states_.matched_readers(); }
  [[nodiscard]] RosCounts counts() const noexcept;

 private:
  void send(dds::RosWriter& writer);

  dds::RosWriter joint_states_, transforms_, static_transforms_, description_, diagnostics_;
  MachineModel model_;
  scene::LinkFrames frames_;
  std::vector<scene::LinkFrame> moving_, fixed_;
  ros::Cdr message_;
  std::uint64_t refused_ = 0;
};

}  // namespace meridian::bridge
