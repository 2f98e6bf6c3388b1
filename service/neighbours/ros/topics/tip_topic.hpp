// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/geometry/vector3.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/neighbours/ros/pace.hpp"
#include "service/recording/mcap/writer.hpp"

namespace meridian::ros {

/// `/tip`: the tool tip in the frame `workpiece`, 25 times a second; its orientation takes +z along
/// the tool axis to the shank; geometry_msgs/PoseStamped. Proof:
/// tests/unit/ros/motion_file_test.cpp.
class TipTopic {
 public:
  explicit TipTopic(mcap::Writer& writer);
  void write(std::int64_t due_ns, const Pose<double>& pose);

 private:
  mcap::Writer& writer_;
  std::uint16_t channel_;
  Pace pace_{kScreenPeriod_ns};
  Cdr message_;
};

}  // namespace meridian::ros
