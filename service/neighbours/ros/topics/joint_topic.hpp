// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/neighbours/ros/message_types.hpp"
#include "service/neighbours/ros/pace.hpp"
#include "service/recording/mcap/writer.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::ros {

/// `/joint_states`: where the joints, then the drives of a stage, are sent, and how fast, 25 times
/// a second for what knows this type and no other; sensor_msgs/JointState.
/// Proof: tests/unit/ros/motion_file_test.cpp.
class JointTopic {
 public:
  JointTopic(mcap::Writer& writer, const MachineModel& model, const Contents& contents);
  void write(const record::RecordingRow& row);

 private:
  mcap::Writer& writer_;
  const MachineModel& model_;
  Contents contents_;
  std::uint16_t channel_;
  Pace pace_{kScreenPeriod_ns};
  Cdr message_;
};

}  // namespace meridian::ros
