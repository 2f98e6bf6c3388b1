// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <iterator>
#include <random>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/units.hpp"
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
    way_ = {std::cos(azimuth), std::sin(azimuth), 0};
    const bool leans = robot.robot.has_spherical_wrist;
    const double lean = leans ? between(0.9, 1.3) : between(-0.3, 0.3);
    const Vector3 beside(-way_.y(), way_.x(), 0);
    axis_ =
        (std::cos(lean) * Vector3::UnitZ() - std::sin(lean) * way_ + between(-0.2, 0.2) * beside)
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
    const Vector3 beside(-way_.y(), way_.x(), 0);
    return at(share, wrist_ + share * (kSweep_mm * way_ + rise_mm_ * Vector3::UnitZ()) +
                         beside_mm * beside);
  }
  [[nodiscard]] ToolPose along(double share, double beside_mm) const override {
    return at(share, wrist_ + beside_mm * way_ + share * kSweep_mm * Vector3::UnitZ());
  }

  Vector3 wrist_, way_, axis_, turn_;
  double rise_mm_ = 0;
};

/// The wrist point comes over the base axis and the tool into line with the forearm of a 6R robot,
/// in the same place or up to three blocks later or earlier; beside both, or beside one and exactly
/// through the other.
class BothPass : public SingularPass {
 public:
  BothPass(const MachineModel& robot, std::uint32_t seed) : SingularPass(robot, seed) {
    const double elbow = between(0.6, 1.6);
    at_ = {between(-1.4, 1.4), bent(elbow), -elbow, between(-1.0, 1.0), 0, 0};
    way_ = {-std::cos(at_[robot::kYaw]), -std::sin(at_[robot::kYaw]), 0};
    constexpr int kShifts[] = {0, 0, 1, -1, 3, -3};
    shift_ = kShifts[seed % std::size(kShifts)] / 30.0;
    const auto kind = seed / std::size(kShifts) % 3;
    shoulder_share_ = kind == 1 ? 0 : 1;
    wrist_share_ = kind == 2 ? 0 : 1;
    rise_mm_ = between(-10, 10);
    elbow_turn_ = between(-0.1, 0.1);
    const ToolPose there = forward(robot, robot.tool_length_mm, at_);
    wrist_ = wrist_of(there);
    axis_ = in_line(shift_, there.axis);
    const Vector3 any{between(-1, 1), between(-1, 1), between(-1, 1)};
    spin_ = any.cross(axis_).normalized();
  }

 private:
  static constexpr double kSweep_rad = 0.17, kSweep_mm = 60;
  /// The shoulder that has the wrist point over the base axis, of arms that are equally long.
  static double bent(double elbow) { return units::rad_from_deg(90) + elbow / 2; }
  [[nodiscard]] double lever_mm() const { return robot_.robot.wrist_mm + robot_.tool_length_mm; }
  [[nodiscard]] Vector3 wrist_of(const ToolPose& pose) const {
    return pose.tip + lever_mm() * pose.axis;
  }
  [[nodiscard]] Vector3 wrist_at(double share) const {
    return wrist_ + share * (kSweep_mm * way_ + rise_mm_ * Vector3::UnitZ());
  }
  /// The axis in line with the forearm at `share` of the way, with any axis near it.
  [[nodiscard]] Vector3 in_line(double share, const Vector3& near) const {
    const ToolPose pose{wrist_at(share) - lever_mm() * near, near};
    const int branch = share > 0 ? robot::kBack : 0;
    JointVector q = share == 0 ? at_ : solve(robot_, robot_.tool_length_mm, pose, branch, at_).q;
    q[robot::kBend] = 0;
    return forward(robot_, robot_.tool_length_mm, q).axis;
  }
  [[nodiscard]] ToolPose across(double share, double beside) const override {
    const Vector3 across_way(-way_.y(), way_.x(), 0);
    const double turn = (share - shift_) * kSweep_rad;
    const double off = std::tan(units::rad_from_deg(beside)) * wrist_share_;
    const Vector3 on = std::cos(turn) * axis_ + std::sin(turn) * spin_.cross(axis_);
    const Vector3 axis = (on + off * spin_).normalized();
    const Vector3 wrist = wrist_at(share) + beside * shoulder_share_ * across_way;
    return {wrist - lever_mm() * axis, axis};
  }
  [[nodiscard]] ToolPose along(double share, double beside) const override {
    JointVector q = at_;
    const double elbow = -at_[robot::kElbow] + share * elbow_turn_;
    q[robot::kElbow] = -elbow;
    q[robot::kShoulder] = bent(elbow);
    q[robot::kBend] = units::rad_from_deg(beside) * wrist_share_;
    const ToolPose on = forward(robot_, robot_.tool_length_mm, q);
    return {on.tip + beside * shoulder_share_ * way_, on.axis};
  }

  JointVector at_{};
  Vector3 way_, wrist_, axis_, spin_;
  double shift_ = 0;                             // of the wrist's place, shares
  double shoulder_share_ = 1, wrist_share_ = 1;  // of what it is beside
  double rise_mm_ = 0, elbow_turn_ = 0;
};

}  // namespace meridian::test
