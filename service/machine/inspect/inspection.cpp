// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/inspection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {
namespace {

constexpr double kTrial_mm = 10, kTrial_deg = 5, kOffPole_deg = 10, kNarrow_deg = 5;
constexpr double kTravelMargin = 1e-9;
constexpr int kRoundTrips = 400;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The joint moved by `step`, or backwards where travel ends before.
JointVector moved(const MachineModel& model, const JointVector& from, int joint, double& step) {
  JointVector q = from;
  const JointSpec& spec = model.joints[at(joint)];
  if (!is_inside_travel(spec, q[at(joint)] + step, 0)) step = -step;
  q[at(joint)] += step;
  return q;
}

JointTrial try_joint(const MachineModel& model, const JointVector& from, int joint) {
  JointTrial out;
  out.joint = joint;
  out.step = model.joints[at(joint)].is_rotary ? units::rad_from_deg(kTrial_deg) : kTrial_mm;
  const ToolPose before = forward(model, model.tool_length_mm, from);
  const ToolPose after = forward(model, model.tool_length_mm, moved(model, from, joint, out.step));
  out.tip_move = after.tip - before.tip;
  out.axis_turn = angle_between(before.axis, after.axis);
  out.axis_towards = after.axis - after.axis.dot(before.axis) * before.axis;
  const double length = out.axis_towards.norm();
  out.axis_towards = length > 1e-12 ? Vector3(out.axis_towards / length) : Vector3::Zero();
  return out;
}

ToolPose leant(double tilt, double azimuth) {
  return {Vector3::Zero(),
          {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)}};
}

void look_at_tilt(const MachineModel& model, Inspection& out) {
  constexpr int kAzimuths = 24;
  bool is_all = true;
  for (int degree = 0; degree <= 180; ++degree) {
    const double tilt = units::rad_from_deg(degree);
    int reached = 0;
    for (int i = 0; i < kAzimuths; ++i) {
      if (is_in_reach(model, leant(tilt, 2 * std::numbers::pi * i / kAzimuths))) ++reached;
    }
    is_all = is_all && reached == kAzimuths;
    if (is_all) out.all_tilt = tilt;
    if (reached > 0) out.some_tilt = tilt;
  }
}

/// How far the tip goes from W's origin along one direction with the tool along z.
double straight_reach(const MachineModel& model, const Vector3& direction) {
  constexpr double kStep_mm = 10, kMax_mm = 20'000;
  const auto reaches = [&](double distance) {
    return is_in_reach(model, {distance * direction, Vector3::UnitZ()});
  };
  double good = 0;
  while (good < kMax_mm && reaches(good + kStep_mm)) good += kStep_mm;
  double bad = good + kStep_mm;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (good + bad);
    (reaches(middle) ? good : bad) = middle;
  }
  return good;
}

void look_at_space(const MachineModel& model, Inspection& out) {
  for (int i = 0; i < 3; ++i) {
    const Vector3 direction = Vector3::Unit(i);
    out.straight[at(i)] = {-straight_reach(model, -direction), straight_reach(model, direction)};
  }
}

/// Joints to pose and back by the branch that comes nearest, over draws inside travel.
void go_round(const MachineModel& model, Inspection& out) {
  std::mt19937_64 draw(20240611);
  for (int n = 0; n < kRoundTrips; ++n) {
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) {
      const JointSpec& joint = model.joints[at(i)];
      const double low = joint.is_endless ? -std::numbers::pi : joint.limits.travel_min;
      const double high = joint.is_endless ? std::numbers::pi : joint.limits.travel_max;
      q[at(i)] = std::uniform_real_distribution<double>(low, high)(draw);
    }
    const ToolPose pose = forward(model, model.tool_length_mm, q);
    double tip = std::numeric_limits<double>::infinity(), axis = tip;
    for (int branch = 0; branch < branch_count(model); ++branch) {
      const auto solution = solve(model, model.tool_length_mm, pose, branch, q);
      if (solution.status == SolveStatus::kUnreachable) continue;
      const ToolPose back = forward(model, model.tool_length_mm, solution.q);
      tip = std::min(tip, (back.tip - pose.tip).norm());
      axis = std::min(axis, angle_between(back.axis, pose.axis));
    }
    out.round_trip_mm = std::max(out.round_trip_mm, tip);
    out.round_trip_axis = std::max(out.round_trip_axis, axis);
  }
}

}  // namespace

bool is_in_reach(const MachineModel& model, const ToolPose& pose) {
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) home[at(i)] = model.joints[at(i)].home;
  for (int branch = 0; branch < branch_count(model); ++branch) {
    auto solution = solve(model, model.tool_length_mm, pose, branch, home);
    if (solution.status == SolveStatus::kUnreachable) continue;
    wind_into_travel(model, home, solution.q);
    if (first_joint_outside_travel(model, solution.q, kTravelMargin) < 0) return true;
  }
  return false;
}

JointVector trial_joints(const MachineModel& model) {
  JointVector q{};
  for (int i = 0; i < model.joint_count; ++i) q[at(i)] = model.joints[at(i)].home;
  const ToolPose pose = forward(model, model.tool_length_mm, q);
  if (redundant_joint(model) < 0 || pole_distance(model, pose.axis) > units::rad_from_deg(1))
    return q;
  const int tilt =
      model.family == MachineFamily::kLai ? static_cast<int>(lai::kTheta2) : model.chain.b.joint;
  double step = units::rad_from_deg(kOffPole_deg);
  return moved(model, q, tilt, step);
}

/// Radius of the cone about the rotary axis next to the workpiece that no tool axis comes into,
/// where it is so narrow that it can hardly be meant; 0: none.
double hole_rad(const MachineModel& model) {
  if (model.family != MachineFamily::kChain || redundant_joint(model) >= 0) return 0;
  const double hole = chain::reach(model.chain).min_rad;
  return hole < units::rad_from_deg(kNarrow_deg) ? hole : 0;
}

Inspection inspect(const MachineModel& model) {
  Inspection out;
  out.skeleton = skeleton_of(model);
  for (int i = 0; i < model.joint_count; ++i) out.home[at(i)] = model.joints[at(i)].home;
  out.home_pose = forward(model, model.tool_length_mm, out.home);
  out.home_measure = measure(model, out.home);
  out.trial_joints = trial_joints(model);
  out.trial_pose = forward(model, model.tool_length_mm, out.trial_joints);
  for (int i = 0; i < model.joint_count; ++i) {
    out.trials.push_back(try_joint(model, out.trial_joints, i));
  }
  out.is_origin_in_reach = is_in_reach(model, {Vector3::Zero(), Vector3::UnitZ()});
  if (out.is_origin_in_reach) {
    look_at_tilt(model, out);
    look_at_space(model, out);
  }
  go_round(model, out);
  Slips slips = find_slips(model, out.skeleton);
  out.warnings = std::move(slips.warnings);
  out.measured = std::move(slips.measured);
  if (!out.is_origin_in_reach) {
    out.warnings.push_back(
        "the origin of the workpiece is out of reach with the tool along its z: place it with "
        "[frame] or --frame, or look at travel");
  }
  if (const double off = std::abs(pole_offset_rad(model)); off > model.tolerances.axis_rad) {
    out.warnings.push_back(
        text::printed("on the pole the tool axis is off by %.3g deg, more than tolerances.axis_deg",
                      units::deg_from_rad(off)));
  }
  if (const double hole = hole_rad(model); hole > 0) {
    out.warnings.push_back(text::printed(
        "no tool axis comes within %.3g deg of that of %s: where the tool is meant to stand along "
        "it, measure directions and tool_axis again",
        units::deg_from_rad(hole), model.joints[at(model.chain.a.joint)].name.c_str()));
  }
  constexpr double kRound_mm = 1e-6;
  if (!(out.round_trip_mm < kRound_mm)) {
    out.warnings.push_back(
        "joints to pose and back does not come home everywhere in travel: travel reaches into a "
        "place where the machine is singular");
  }
  return out;
}

}  // namespace meridian::inspect
