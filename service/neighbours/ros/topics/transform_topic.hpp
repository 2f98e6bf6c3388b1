// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/scene/link_frames.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/neighbours/ros/pace.hpp"
#include "service/recording/mcap/writer.hpp"

namespace meridian::ros {

/// `/tf`: where the links of the machine are, 25 times a second; tf2_msgs/TFMessage.
/// Proof: tests/unit/ros/scene_topics_test.cpp, tests/mcap/read_test.mjs.
class TransformTopic {
 public:
  TransformTopic(mcap::Writer& writer, const MachineModel& model);
  void write(std::int64_t due_ns, const JointVector& joints);
  [[nodiscard]] const scene::LinkFrames& frames() const noexcept { return frames_; }

 private:
  mcap::Writer& writer_;
  std::uint16_t channel_;
  scene::LinkFrames frames_;
  double tool_length_mm_;
  Pace pace_{kScreenPeriod_ns};
  Cdr message_;
};

}  // namespace meridian::ros
