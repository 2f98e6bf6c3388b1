// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/neighbours/ros/message_types.hpp"
#include "service/neighbours/ros/pace.hpp"
#include "service/recording/mcap/writer.hpp"
#include "service/recording/record/file/recorded/sent_positions.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::ros {

/// `/drives`: how far every drive is from the setpoint that it had seen, and what it says of
/// itself; meridian_msgs/Drives. Every row of the flight recorder, whose files are short; else the
/// largest error of every 40 ms. Proof: tests/unit/ros/motion_file_test.cpp.
class DrivesTopic {
 public:
  DrivesTopic(mcap::Writer& writer, const MachineModel& model, const Contents& contents);
  void write(const record::RecordingRow& row);

 private:
  mcap::Writer& writer_;
  const MachineModel& model_;
  Contents contents_;
  std::uint16_t channel_;
  record::SentPositions sent_;
  JointVector worst_{};  ///< following errors since the last message
  Pace pace_;
  Cdr message_;
};

}  // namespace meridian::ros
