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

  double block_end_s = 0;  ///< where blocks end on their paths, mm; 0: at the end
  double stop_share = 1;   ///< of the limits that stops may use; 0: there is no authority

  /// Pieces that follow carry `epoch`.
  void set_epoch(std::uint16_t epoch) { epoch_ = epoch; }
  /// What comes is planned for so many times its feed.
  void set_feed_factor(double factor) { feed_factor_ = factor; }

  /// Moves the tip by `delta` inside `limits`; stops may use them too, FaultStops twice the
  /// acceleration and four times the jerk.
  void cut(const Vector3& delta, const PathLimits& limits, MotionKind motion = MotionKind::kCut) {
    const PathPiece path = stage_path(delta, motion);
    const ProfilePhases phases =
        phases_of(rest_to_rest_with_reserve(path.length, limits), path.length);
    for (int i = 0; i < phases.count; ++i) {
      stage_phase(phases.phase[static_cast<std::size_t>(i)], path, 0, limits);
    }
    end_window();
  }

  /// As cut(), in one motion over two path pieces that meet in the middle.
  void cut_over_two_paths(const Vector3& delta, const PathLimits& limits) {
    const double length = delta.norm();
    const ProfilePhases phases = phases_of(rest_to_rest_with_reserve(length, limits), length);
    const PathPiece first = stage_path(delta / 2, MotionKind::kCut, false);
    const PathPiece second = stage_path(delta / 2, MotionKind::kCut);
    for (int i = 0; i < phases.count; ++i) {
      ProfilePhase phase = phases.phase[static_cast<std::size_t>(i)];
      const double middle = phase.v > 0 ? (length / 2 - phase.s) / phase.v : 0;
      if (phase.a == 0 && phase.j == 0) {  // the cruise holds the middle
        const double whole = phase.duration;
        phase.duration = middle;
        stage_phase(phase, first, 0, limits);
        phase.duration = whole - middle;
        phase.s = length / 2;
      }
      const bool is_second = phase.s >= length / 2;
      stage_phase(phase, is_second ? second : first, is_second ? length / 2 : 0, limits);
    }
    end_window();
  }

  /// Sets off along `delta` in a window that ends at cruising speed after `cruise_s`, with the stop
  /// from there as its tail. continue_cut() publishes the window that goes on instead.
  void cut_with_tail(const Vector3& delta, const PathLimits& limits, double cruise_s) {
    long_path_ = stage_path(delta, MotionKind::kCut);
    long_limits_ = limits;
    const Profile profile = rest_to_rest_with_reserve(long_path_.length, limits);
    const ProfilePhases phases = phases_of(profile, long_path_.length);
    for (int i = 0; i < 4; ++i) {
      ProfilePhase phase = phases.phase[static_cast<std::size_t>(i)];
      if (i == 3) phase.duration = cruise_s;
      stage_phase(phase, long_path_, 0, limits);
    }
    cruise_ = phases.phase[3];
    cruise_.s += cruise_.v * cruise_s;
    stage_stop(cruise_.s - phases.phase[4].s, phases, true);
    writer_.publish();
    ++window_;
  }
  void continue_cut() {
    const double length = long_path_.length;
    const ProfilePhases phases = phases_of(rest_to_rest_with_reserve(length, long_limits_), length);
    is_next_from_rest_ = false;
    cruise_.duration = (phases.phase[4].s - cruise_.s) / cruise_.v;
    stage_phase(cruise_, long_path_, 0, long_limits_);
    stage_stop(0, phases, false);
    is_next_from_rest_ = true;
    end_window();
  }

  void barrier(TimeKind kind, double duration = 0) {
    TimePiece piece = next_piece(kind);
    piece.duration = duration;
    (void)writer_.stage(piece);
    end_window();
  }

 private:
  PathPiece stage_path(const Vector3& delta, MotionKind motion, bool ends_block = true) {
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
    if (ends_block) path.marks.add({block_end_s > 0 ? block_end_s : path.length, 0, path.line});
    (void)writer_.stage(path);
    return path;
  }
  void stage_phase(const ProfilePhase& phase, const PathPiece& path, double begin,
                   const PathLimits& limits, bool is_tail = false) {
    TimePiece piece = next_piece(TimeKind::kMove);
    piece.is_tail = is_tail;
    piece.path_index = path.index;
    piece.duration = phase.duration;
    piece.s0 = phase.s - begin;
    piece.v = phase.v;
    piece.a = phase.a;
    piece.j = phase.j;
    piece.stop_accel = stop_share * limits.acceleration;
    piece.stop_jerk = stop_share * limits.jerk;
    piece.fault_accel = 2 * stop_share * limits.acceleration;
    piece.fault_jerk = 4 * stop_share * limits.jerk;
    (void)writer_.stage(piece);
  }
  /// The last three phases of a profile, `by` further on.
  void stage_stop(double by, const ProfilePhases& phases, bool is_tail) {
    for (std::size_t i = 4; i < 7; ++i) {
      ProfilePhase phase = phases.phase[i];
      phase.s += by;
      stage_phase(phase, long_path_, 0, long_limits_, is_tail);
    }
  }
  TimePiece next_piece(TimeKind kind) const {
    TimePiece piece;
    piece.kind = kind;
    piece.feed_factor = feed_factor_;
    piece.is_from_rest = is_next_from_rest_;
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
  double feed_factor_ = 1;
  bool is_next_from_rest_ = true;
  PathPiece long_path_;  ///< of cut_with_tail
  PathLimits long_limits_;
  ProfilePhase cruise_;
};

}  // namespace meridian::test
