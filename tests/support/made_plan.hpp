// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/profile.hpp"

namespace meridian::test {

/// A plan made by hand for tests of the cycle: straight cuts of the tip from rest to rest and
/// barriers, one window each, written through the motion port as a planner does.
class MadePlan {
 public:
  MadePlan(const MachineModel& machine, MotionPort& port, const ToolPose& begin)
      : machine_(machine), writer_(port), pose_(begin) {
    joints_ = solve(machine, machine.tool_length_mm, begin, 0, {}).q;
  }

  [[nodiscard]] const JointVector& joints() const { return joints_; }

  /// Pieces that follow carry `epoch`.
  void set_epoch(std::uint16_t epoch) { epoch_ = epoch; }

  /// Moves the tip by `delta` inside `limits`; stops may use them too, FaultStops twice the
  /// acceleration and four times the jerk.
  void cut(const Vector3& delta, const PathLimits& limits, MotionKind motion = MotionKind::kCut) {
    const PathPiece path = stage_path(delta, motion);
    const ProfilePhases phases =
        phases_of(rest_to_rest_with_reserve(path.length, limits), path.length);
    for (int i = 0; i < phases.count; ++i) {
      TimePiece piece = next_piece(TimeKind::kMove);
      const ProfilePhase& phase = phases.phase[static_cast<std::size_t>(i)];
      piece.path_index = path.index;
      piece.duration = phase.duration;
      piece.s0 = phase.s;
      piece.v = phase.v;
      piece.a = phase.a;
      piece.j = phase.j;
      piece.stop_accel = limits.acceleration;
      piece.stop_jerk = limits.jerk;
      piece.fault_accel = 2 * limits.acceleration;
      piece.fault_jerk = 4 * limits.jerk;
      (void)writer_.stage(piece);
    }
    end_window();
  }

  void barrier(TimeKind kind, double duration = 0) {
    TimePiece piece = next_piece(kind);
    piece.duration = duration;
    (void)writer_.stage(piece);
    end_window();
  }

 private:
  PathPiece stage_path(const Vector3& delta, MotionKind motion) {
    PathPiece path;
    path.index = index_++;
    path.sequence = sequence_;
    path.line = static_cast<std::uint32_t>(10 + sequence_);
    path.motion = motion;
    path.epoch = epoch_;
    path.length = delta.norm();
    path.tool_length_mm = machine_.tool_length_mm;
    path.tip_begin = to_array(pose_.tip);
    path.tip_delta = to_array(delta);
    path.axis_begin = to_array(pose_.axis);
    path.joints_begin = joints_;
    pose_.tip += delta;
    joints_ = solve(machine_, machine_.tool_length_mm, pose_, 0, joints_).q;
    path.joints_end = joints_;
    (void)writer_.stage(path);
    return path;
  }
  TimePiece next_piece(TimeKind kind) const {
    TimePiece piece;
    piece.kind = kind;
    piece.is_from_rest = true;
    piece.epoch = epoch_;
    piece.window = window_;
    piece.sequence = sequence_;
    piece.line = static_cast<std::uint32_t>(10 + sequence_);
    return piece;
  }
  void end_window() {
    writer_.publish();
    ++window_;
    ++sequence_;
  }

  const MachineModel& machine_;
  MotionWriter writer_;
  ToolPose pose_;
  JointVector joints_{};
  std::uint64_t index_ = 0, sequence_ = 0;
  std::uint32_t window_ = 0;
  std::uint16_t epoch_ = 1;
};

}  // namespace meridian::test
