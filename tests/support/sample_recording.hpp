// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/cl_block.hpp"

/// Recordings for tests, made without planner and cycle: every block from rest to rest by one
/// polynomial of degree seven.
namespace meridian::test {

/// A straight cut to `tip` with the tool tilted by `tilt_rad` towards +x. Feed in mm/s.
[[nodiscard]] inline ClBlock cut_to(std::uint32_t line, const Vector3& tip, double tilt_rad,
                                    double feed) {
  ClBlock block;
  block.line = line;
  block.sequence = line;
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = feed;
  block.tip_mm = to_array(tip);
  block.axis = {std::sin(tilt_rad), 0, std::cos(tilt_rad)};
  return block;
}

/// Runs through the blocks of a straight path; the first one is where the run begins.
class SampleRun {
 public:
  SampleRun(const MachineModel& model, const std::vector<ClBlock>& blocks) : model_(model) {
    const ToolPose begin{to_vector(blocks[0].tip_mm), to_vector(blocks[0].axis).normalized()};
    const auto start = solve(model, model.tool_length_mm, begin, 0, JointVector{});
    joints_ = start.q;
    rest(20, blocks[0].line);
    ToolPose from = begin;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      const ToolPose to{to_vector(blocks[i].tip_mm), to_vector(blocks[i].axis).normalized()};
      move(from, to, blocks[i]);
      from = to;
    }
    rest(20, blocks.back().line);
  }

  std::vector<CycleRecord> records;

 private:
  void rest(int cycles, std::uint32_t line) {
    for (int i = 0; i < cycles; ++i) add(joints_, JointVector{}, line, 0);
  }

  /// s(u) = 35u⁴ - 84u⁵ + 70u⁶ - 20u⁷: largest slope 2.1875, no jerk at the ends.
  void move(const ToolPose& from, const ToolPose& to, const ClBlock& block) {
    const GreatCircle circle = find_great_circle(from.axis, to.axis);
    const double distance = (to.tip - from.tip).norm();
    const double min = std::max({2.1875 * distance / (0.9 * block.feed), 6.0 * circle.turn, 0.05});
    const double period = static_cast<double>(model_.cycle_ns) * 1e-9;
    const double duration = period * std::ceil(min / period);
    for (double t = period; t < duration + 0.5 * period; t += period) {
      const Jet<1> u = Jet<1>::variable(std::min(1.0, t / duration));
      const Jet<1> s = u * u * u * u * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u)));
      Pose<Jet<1>> pose;
      for (int i = 0; i < 3; ++i) {
        pose.tip[i] = from.tip[i] + s * (to.tip[i] - from.tip[i]);
      }
      pose.axis = axis_on_circle(circle.begin, circle.normal, Jet<1>(s * circle.turn));
      const auto solved = solve(model_, model_.tool_length_mm, pose, 0, joints_);
      JointVector velocity{};
      for (int i = 0; i < model_.joint_count; ++i) {
        joints_[i] = value_of(solved.q[i]);
        velocity[i] = solved.q[i].derivative(1) / duration;
      }
      add(joints_, velocity, block.line, period);
    }
  }

  void add(const JointVector& joints, const JointVector& velocity, std::uint32_t line,
           double plan_step_s) {
    CycleRecord record;
    record.setpoint.cycle = 100 + records.size();
    record.setpoint.due_ns =
        5'000'000'000 + static_cast<std::int64_t>(records.size()) * model_.cycle_ns;
    Joints<Jet<1>> moving;
    for (std::size_t i = 0; i < moving.size(); ++i) {
      moving[i] = Jet<1>::with_derivative(joints[i], velocity[i]);
    }
    const Joints<Jet<1>> drives = drives_of(model_, moving);
    for (std::size_t i = 0; i < drives.size(); ++i) {
      record.setpoint.position[i] = value_of(drives[i]);
      record.setpoint.velocity[i] = drives[i].derivative(1);
    }
    record.setpoint.line = line;
    record.setpoint.flags = kSetpointEnabled;
    record.joints = joints;
    record.sequence = line;
    record.state = State::kRunning;
    record.motion = MotionKind::kCut;
    plan_time_s_ += plan_step_s;
    record.plan_time_s = plan_time_s_;
    records.push_back(record);
  }

  const MachineModel& model_;
  JointVector joints_{};
  double plan_time_s_ = 0;
};

}  // namespace meridian::test
