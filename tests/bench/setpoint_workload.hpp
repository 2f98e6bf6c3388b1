// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "meridian/planner/time_law.hpp"
#include "support/dense_block.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

/// Setpoints of smooth plans, as the cycle evaluates them, and the bare inverse kinematics of their
/// poses.
namespace meridian::bench {

enum class SetpointsOf {
  kSpline,  ///< a winding pass far from the pole
  kPole     ///< passes at 0.05 deg from the pole, where the redundant joint is driven and the tilt
            ///< follows
};

/// 0.3 mm blocks of a curve, or passes of 60 mm to and fro beside the pole, 100 mm/s.
[[nodiscard]] inline std::vector<ClBlock> setpoint_program(SetpointsOf what) {
  constexpr int kCurve = 400, kPasses = 4;
  std::vector<ClBlock> blocks;
  if (what == SetpointsOf::kSpline) {
    for (int i = 0; i < kCurve; ++i) {
      blocks.push_back(test::dense_block(static_cast<std::uint64_t>(i), 0.3, 100));
    }
  } else {
    for (int i = 0; i <= kPasses; ++i) {
      const double side = i % 2 == 0 ? -1 : 1, tilt = side * units::rad_from_deg(15);
      const double beside = units::rad_from_deg(0.05);
      ClBlock block;
      block.sequence = static_cast<std::uint64_t>(i);
      block.line = static_cast<std::uint32_t>(i + 1);
      block.feed_meaning = FeedMeaning::kTip;
      block.feed = 100;
      block.tip_mm = {40 + 30 * side, 10 + 0.5 * i, 0};
      block.axis = {std::cos(beside) * std::sin(tilt), std::sin(beside),
                    std::cos(beside) * std::cos(tilt)};
      blocks.push_back(block);
    }
  }
  test::end_program(blocks);
  return blocks;
}

/// The setpoints of a plan, one a millisecond.
class Setpoints {
 public:
  explicit Setpoints(SetpointsOf what) : model_(test::bench_machine()) {
    model_.transition = Transition::kSmooth;
    const auto blocks = setpoint_program(what);
    const ToolPose begin{to_vector(blocks.front().tip_mm), to_vector(blocks.front().axis)};
    begin_ = solve(model_, model_.tool_length_mm, begin, 0, JointVector{}).q;
    SmoothPlanner planner(model_);
    planner.begin(begin_, model_.tool_length_mm, 0);
    planner.look_no_further();
    const auto port = std::make_unique<MotionPort>();
    MotionWriter writer(*port);
    MotionReader reader(*port);
    for (const ClBlock& block : blocks) {
      PlanStatus status = PlanStatus::kNoRoom;
      while ((status = planner.plan(block, writer).status) == PlanStatus::kNoRoom)
        read(reader, what);
      if (status == PlanStatus::kRefused) return;
    }
    read(reader, what);
  }

  [[nodiscard]] std::size_t size() const noexcept { return samples_.size(); }

  /// Evaluates `n` setpoints, joints and velocities; returns a checksum of the joints.
  [[nodiscard]] std::uint64_t evaluate(int n) const noexcept {
    JointVector q = samples_.front().joints, velocity{};
    std::uint64_t sum = 0;
    std::size_t at = 0;
    for (int i = 0; i < n; ++i, at = at + 1 < samples_.size() ? at + 1 : 0) {
      const Sample& sample = samples_[at];
      const PathPiece& path = paths_[sample.path];
      const PathState state = state_at(sample.time, sample.t);
      const auto moving =
          joints_at(model_, path, Jet<1>::variable(std::clamp(state.s, 0.0, path.length)), q);
      for (std::size_t k = 0; k < static_cast<std::size_t>(model_.joint_count); ++k) {
        q[k] = value_of(moving.q[k]);
        velocity[k] = moving.q[k].derivative(1) * state.ds;
      }
      sum += bits_of(q[3]) ^ bits_of(velocity[4]);
    }
    return sum;
  }

  /// The bare inverse kinematics of the same poses.
  [[nodiscard]] std::uint64_t solve_poses(int n) const noexcept {
    JointVector q = samples_.front().joints;
    std::uint64_t sum = 0;
    std::size_t at = 0;
    for (int i = 0; i < n; ++i, at = at + 1 < samples_.size() ? at + 1 : 0) {
      const Sample& sample = samples_[at];
      q = solve(model_, model_.tool_length_mm, sample.pose, paths_[sample.path].branch, q).q;
      sum += bits_of(q[3]);
    }
    return sum;
  }

 private:
  struct Sample {
    TimePiece time;
    double t = 0;  ///< since the begin of the time piece
    std::size_t path = 0;
    ToolPose pose;
    JointVector joints{};
  };

  [[nodiscard]] static std::uint64_t bits_of(double x) noexcept {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
  }

  /// What the port holds: setpoints on spans, beside the pole on those that drive the redundant
  /// joint.
  void read(MotionReader& reader, SetpointsOf what) {
    while (const TimePiece* time = reader.advance()) {
      const PathPiece* path = reader.path();
      const bool is_wanted = path != nullptr && path->kind == PathKind::kSpline &&
                             (what == SetpointsOf::kSpline || path->is_free_driven);
      for (; t_ < time->duration; t_ += 1e-3) {
        if (is_wanted) add(*time, *path);
      }
      t_ -= time->duration;
    }
  }

  void add(const TimePiece& time, const PathPiece& path) {
    if (paths_.empty() || paths_.back().index != path.index) paths_.push_back(path);
    const double s = std::clamp(state_at(time, t_).s, 0.0, path.length);
    const JointVector& reference = samples_.empty() ? path.joints_begin : samples_.back().joints;
    samples_.push_back(
        {time, t_, paths_.size() - 1, pose_at(path, s), joints_at(model_, path, s, reference).q});
  }

  MachineModel model_;
  JointVector begin_{};
  std::vector<PathPiece> paths_;
  std::vector<Sample> samples_;
  double t_ = 0;
};

/// A checksum of `n` setpoints; 0 where there are too few.
[[nodiscard]] inline std::uint64_t run_setpoints(SetpointsOf what, int n) {
  const Setpoints setpoints(what);
  return setpoints.size() > 100 ? setpoints.evaluate(n) | 1U : 0;
}

}  // namespace meridian::bench
