// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/scene/bodies.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/neighbours/ros/pace.hpp"
#include "service/recording/mcap/writer.hpp"

namespace meridian::ros {

/// `/machine`: its bodies, which move with the frames of `/tf`, once at the begin; `/trail`: the
/// path of the tip in the workpiece frame, every two seconds the last 20 s of it, so that it is
/// there wherever a viewer jumps to. Both visualization_msgs/MarkerArray. Proof:
/// tests/unit/ros/scene_topics_test.cpp.
class MarkerTopic {
 public:
  MarkerTopic(mcap::Writer& writer, const MachineModel& model, const scene::LinkFrames& frames);
  void write(std::int64_t due_ns, const Vector3& tip_mm);
  /// Writes the trail up to the last row.
  void finish(std::int64_t due_ns);

 private:
  static constexpr std::size_t kMaxPoints = 500;
  static constexpr std::int64_t kTrailPeriod_ns = 2'000'000'000;

  void write_bodies(std::int64_t due_ns);
  void write_trail(std::int64_t due_ns);

  mcap::Writer& writer_;
  std::uint16_t machine_, trail_;  ///< channels
  std::vector<scene::Body> bodies_;
  bool has_bodies_ = false;
  std::vector<Array3> points_;  ///< m; a ring when it is full
  std::size_t oldest_ = 0;
  Pace point_pace_{kScreenPeriod_ns}, trail_pace_{kTrailPeriod_ns};
  bool is_written_ = true;  ///< every point is in a message
  Cdr message_;
};

}  // namespace meridian::ros
