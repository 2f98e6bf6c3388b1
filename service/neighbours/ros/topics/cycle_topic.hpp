// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/neighbours/ros/derived_row.hpp"
#include "service/neighbours/ros/message_types.hpp"
#include "service/recording/mcap/writer.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::ros {

/// `/cycle`: every row, all that it says of the motion, and tip, tool axis and feed that follow;
/// meridian_msgs/Cycle. One message and no more for each row, because a message costs 25 bytes
/// beside what is in it. Proof: tests/unit/ros/motion_file_test.cpp, tests/mcap/read_test.mjs.
class CycleTopic {
 public:
  CycleTopic(mcap::Writer& writer, const MachineModel& model, const Contents& contents);
  void write(const record::RecordingRow& row, const DerivedRow& derived);

 private:
  void put_positions(const record::RecordingRow& row, const Pose<double>& pose);
  void put_velocities(const record::RecordingRow& row, const DerivedRow& derived);

  mcap::Writer& writer_;
  const MachineModel& model_;
  Contents contents_;
  std::uint16_t channel_;
  Cdr message_;
};

}  // namespace meridian::ros
