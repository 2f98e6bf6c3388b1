// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "service/neighbours/bridge/drive_positions.hpp"
#include "service/neighbours/bridge/ros_publisher.hpp"
#include "service/neighbours/bridge/sent_setpoint.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/reader.hpp"

namespace meridian::bridge {

/// The times of one step. ROS stamps messages with the system's clock; ages are told by the
/// monotonic one.
struct BridgeTime {
  std::int64_t steady_ns = 0, system_ns = 0;
};

/// Takes what a service and its drives say and publishes it for ROS 2. Joints are where the drives
/// report them; where not all do, where they are sent. It changes nothing of the machine: all of
/// its readers are those of any viewer. Proof: tests/ros/ros_bridge_test.cpp.
class RosBridge {
 public:
  /// `model`: of the machine that `machine` is a participant of. Throws dds::DdsError.
  RosBridge(dds::Participant& machine, dds::Participant& ros, const MachineModel& model,
            BridgeTime now);

  /// One step: joints and frames where something new came, diagnostics once a second, the
  /// description where the machine's frame or tool changed.
  void work(BridgeTime now);
  [[nodiscard]] int joint_state_readers() const noexcept {
    return publisher_.joint_state_readers();
  }
  [[nodiscard]] RosCounts counts() const noexcept { return publisher_.counts(); }

 private:
  void take(BridgeTime now);
  /// The machine as its service has it, where it said so since the last step.
  [[nodiscard]] std::optional<MachineModel> newly_served();
  /// Describes the machine anew where its frame or the tool in its spindle is another.
  void describe(std::int64_t system_ns);
  void publish_joints(std::int64_t system_ns);

  dds::Reader<dds::MachineInfo> machines_;
  dds::Reader<dds::Status> statuses_;
  dds::Reader<dds::SetpointSample> setpoints_;
  dds::Reader<dds::DriveFeedback> feedbacks_;
  dds::Followed<dds::MachineInfo> followed_machine_;
  dds::Followed<dds::Status> followed_status_;
  RosPublisher publisher_;
  DrivePositions drives_;
  SentSetpoint sent_;
  std::optional<dds::Status> status_;
  std::int64_t status_ns_ = 0, diagnosed_ns_ = 0;
  bool is_news_ = false;  ///< a position came since the last step
};

}  // namespace meridian::bridge
