// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/cl_block.hpp"
#include "property/planner/plan_trace.hpp"
#include "support/program_end.hpp"

/// Programs that pass a singular place of a robot: through it, onto it, off it and along it,
/// exactly or beside.
namespace meridian::test {

enum class Pass { kThrough, kOnto, kOff, kAlong };
inline constexpr Pass kPasses[] = {Pass::kThrough, Pass::kOnto, Pass::kOff, Pass::kAlong};
inline constexpr const char* kPassNames[] = {"through", "onto", "off", "along"};

class SingularPass {
 public:
  SingularPass(const MachineModel& robot, std::uint32_t seed) : robot_(robot), random_(seed) {}
  virtual ~SingularPass() = default;

  /// The tool `beside` the singular place (rad or mm) at its nearest.
  [[nodiscard]] std::vector<ClBlock> program(Pass pass, double beside) const {
    constexpr int kBlocks = 30;
    std::vector<ClBlock> blocks;
    const int first = pass == Pass::kOff ? 0 : -kBlocks, last = pass == Pass::kOnto ? 0 : kBlocks;
    for (int n = first; n <= last; ++n) {
      const double share = 1.0 * n / kBlocks;
      const ToolPose at = pass == Pass::kAlong ? along(share, beside) : across(share, beside);
      ClBlock block;
      block.kind = BlockKind::kCut;
      block.tip_mm = to_array(at.tip);
      block.axis = to_array(at.axis);
      block.feed = 50;
      block.feed_meaning = FeedMeaning::kTip;
      block.sequence = static_cast<std::uint64_t>(n - first);
      block.line = static_cast<std::uint32_t>(n - first + 1);
      blocks.push_back(block);
    }
    end_program(blocks);
    return blocks;
  }

 protected:
  /// The pose at `share` of the way, -1 to 1.
  [[nodiscard]] virtual ToolPose across(double share, double beside) const = 0;
  [[nodiscard]] virtual ToolPose along(double share, double beside) const = 0;
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  const MachineModel& robot_;

 private:
  std::mt19937 random_;
};

/// Where the cycle comes to rest: the planner of a refused program does not say.
inline JointVector end_of(const MachineModel& model, const Trace& trace, JointVector joints) {
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    const TimePiece& piece = trace.times[n];
    if (piece.kind != TimeKind::kMove) continue;
    for (const double share : {0.5, 1.0}) {
      const double s = state_at(piece, share * piece.duration).s;
      joints = joints_at(model, trace.paths[n], s, joints).q;
    }
  }
  return joints;
}

/// The tool comes into line with the forearm of a 6R robot.
class WristPass : public SingularPass {
 public:
  WristPass(const MachineModel& robot, std::uint32_t seed) : SingularPass(robot, seed) {
    at_ = {between(-0.9, 0.9), between(0.7, 1.4), between(-2.2, -1.2), between(-1.0, 1.0), 0, 0};
    pose_ = forward(robot, robot.tool_length_mm, at_);
    const Vector3 any{between(-1, 1), between(-1, 1), between(-1, 1)};
    spin_ = any.cross(pose_.axis).normalized();
    tip_ = between(0, 30) * Vector3(between(-1, 1), between(-1, 1), between(-1, 1));
    for (const int joint : {0, 1, 2, 3}) along_[joint] = between(-0.1, 0.1);
  }

 private:
  static constexpr double kSweep_rad = 0.17;
  [[nodiscard]] ToolPose across(double share, double beside_rad) const override {
    const double turn = share * kSweep_rad;
    const Vector3 on = std::cos(turn) * pose_.axis + std::sin(turn) * spin_.cross(pose_.axis);
    return {pose_.tip + share * tip_, (on + std::tan(beside_rad) * spin_).normalized()};
  }
  [[nodiscard]] ToolPose along(double share, double beside_rad) const override {
    JointVector q = at_;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += share * along_[i];
    q[robot::kBend] = beside_rad;
    return forward(robot_, robot_.tool_length_mm, q);
  }

  JointVector at_{}, along_{};
  ToolPose pose_{Vector3::Zero(), Vector3::UnitZ()};
  Vector3 spin_, tip_;
};

/// The wrist point comes over the base axis, the tool nearly in the plane of the way: nearly
/// upright at a 5R robot, leaning at a 6R one, whose bend has no room for the other.
class ShoulderPass : public SingularPass {
 public:
  ShoulderPass(const MachineModel& robot, std::uint32_t seed) : SingularPass(robot, seed) {
    const double azimuth = between(-1.4, 1.4), height_mm = between(820, 1250);
    wrist_ = {0, 0, robot.robot.shoulder_height_mm + height_mm};
    direction_ = {std::cos(azimuth), std::sin(azimuth), 0};
    const bool leans = robot.robot.has_spherical_wrist;
    const double lean = leans ? between(0.9, 1.3) : between(-0.3, 0.3);
    const Vector3 beside(-direction_.y(), direction_.x(), 0);
    axis_ = (std::cos(lean) * Vector3::UnitZ() - std::sin(lean) * direction_ +
             between(-0.2, 0.2) * beside)
                .normalized();
    turn_ = Vector3(between(-0.1, 0.1), between(-0.1, 0.1), 0);
    rise_mm_ = between(-20, 20);
  }

 private:
  static constexpr double kSweep_mm = 60;
  [[nodiscard]] ToolPose at(double share, const Vector3& wrist) const {
    const Vector3 axis = (axis_ + share * turn_).normalized();
    return {wrist - (robot_.robot.wrist_mm + robot_.tool_length_mm) * axis, axis};
  }
  [[nodiscard]] ToolPose across(double share, double beside_mm) const override {
    const Vector3 beside(-direction_.y(), direction_.x(), 0);
    return at(share, wrist_ + share * (kSweep_mm * direction_ + rise_mm_ * Vector3::UnitZ()) +
                         beside_mm * beside);
  }
  [[nodiscard]] ToolPose along(double share, double beside_mm) const override {
    return at(share, wrist_ + beside_mm * direction_ + share * kSweep_mm * Vector3::UnitZ());
  }

  Vector3 wrist_, direction_, axis_, turn_;
  double rise_mm_ = 0;
};

/// Both at once: the wrist point comes over the base axis and the tool into line with the forearm,
/// there or within 12 mm. `beside` counts in tolerances of the tip and of the axis.
class BothPass : public SingularPass {
 public:
  BothPass(const MachineModel& robot, std::uint32_t seed) : SingularPass(robot, seed) {
    half_elbow_ = between(0.5, 0.9);
    at_[robot::kYaw] = between(-1.2, 1.2);
    at_[robot::kRoll] = between(-1.0, 1.0);
    pose_ = forward(robot, robot.tool_length_mm, arm(half_elbow_, 0, 0, 0));
    wrist_ = pose_.tip + pivot_mm() * pose_.axis;
    // From the front: from behind the arm would stand turned by 180°, its wrist far from singular.
    direction_ = {-std::cos(at_[robot::kYaw]), -std::sin(at_[robot::kYaw]), 0};
    const Vector3 any{between(-1, 1), between(-1, 1), between(-1, 1)};
    spin_ = any.cross(pose_.axis).normalized();
    rise_mm_ = between(-20, 20);
    apart_ = seed % 2 == 0 ? between(-0.2, 0.2) : 0;
    for (const int joint : {int{robot::kYaw}, int{robot::kRoll}})
      along_[joint] = between(-0.1, 0.1);
  }

 private:
  static constexpr double kSweep_mm = 60, kSweep_rad = 0.17, kSweepElbow_rad = 0.05;
  [[nodiscard]] double pivot_mm() const { return robot_.robot.wrist_mm + robot_.tool_length_mm; }
  /// With the wrist point `reach_mm` before the base axis: upper arm and forearm are equally long.
  [[nodiscard]] JointVector arm(double half_elbow, double reach_mm, double bend,
                                double share) const {
    JointVector q = at_;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += share * along_[i];
    const double height_mm = 2 * robot_.robot.forearm_mm * std::cos(half_elbow);
    q[robot::kElbow] = -2 * half_elbow;
    q[robot::kShoulder] = std::acos(reach_mm / height_mm) + half_elbow;
    q[robot::kBend] = bend;
    return q;
  }
  [[nodiscard]] ToolPose across(double share, double beside) const override {
    const double turn = (share - apart_) * kSweep_rad;
    const Vector3 on = std::cos(turn) * pose_.axis + std::sin(turn) * spin_.cross(pose_.axis);
    const double beside_rad = beside * robot_.tolerances.axis_rad;
    const Vector3 axis = (on + std::tan(beside_rad) * spin_).normalized();
    const Vector3 wrist =
        wrist_ + share * (kSweep_mm * direction_ + rise_mm_ * Vector3::UnitZ()) +
        beside * robot_.tolerances.tip_mm * Vector3(-direction_.y(), direction_.x(), 0);
    return {wrist - pivot_mm() * axis, axis};
  }
  [[nodiscard]] ToolPose along(double share, double beside) const override {
    return forward(robot_, robot_.tool_length_mm,
                   arm(half_elbow_ + share * kSweepElbow_rad, beside * robot_.tolerances.tip_mm,
                       beside * robot_.tolerances.axis_rad, share));
  }

  JointVector at_{}, along_{};
  ToolPose pose_{Vector3::Zero(), Vector3::UnitZ()};
  Vector3 wrist_, direction_, spin_;
  double half_elbow_ = 0, rise_mm_ = 0, apart_ = 0;
};

}  // namespace meridian::test
