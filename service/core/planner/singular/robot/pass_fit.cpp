// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/pass_fit.hpp"

#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "service/core/planner/singular/robot/pass_joints.hpp"

namespace meridian {
namespace {

constexpr double kMaxBend_rad = 1e3;  // roll'' h² at an end, beyond it the end is no guide

/// How a joint comes to an end of a pass: value and derivatives by its share.
struct JointEnd {
  double value = 0, rate = 0, bend = 0;
};

FreeQuintic quintic_between(const JointEnd& a, const JointEnd& b) noexcept {
  return {a.value,
          a.value + a.rate / 5,
          a.value + 0.4 * a.rate + a.bend / 20,
          b.value - 0.4 * b.rate + b.bend / 20,
          b.value - b.rate / 5,
          b.value};
}

JointEnd end_of(const auto& joint, double h) noexcept {
  return {value_of(joint), joint.derivative(1) * h, joint.derivative(2) * h * h};
}

bool is_guide(const JointEnd& end) noexcept { return std::abs(end.bend) < kMaxBend_rad; }

/// Where the joint rests the wrist, or the arm, is not turned over.
void keep_side(RobotPass& pass, Singularity at) noexcept {
  const int bit = turned_over(at);
  pass.branch_after = (pass.branch_after & ~bit) | (pass.branch_before & bit);
}

}  // namespace

bool PassFit::fit(RobotPass& pass, double rest_turn) noexcept {
  if (!(pass.end - pass.begin > 2 * kSamePoint_mm)) return false;
  // Beside both rounding would turn the roll of the exact path that leads there.
  if (pass.at == SingularSet::kWristAndShoulder && pass.begin > range_.from &&
      is_beside_both(pass.begin)) {
    return false;
  }
  JointVector reference = range_.joints;
  if ((range_.rests_at_from & pass.at) == SingularSet::kNone &&
      !follow({range_.from, pass.begin, range_.branch, false}, reference)) {
    return false;
  }
  pass.rests_at_end = range_.rests_at_to & only(first_of(pass.at));
  if (pass.at == SingularSet::kWristAndShoulder && !ends_with_range(pass) &&
      !is_over_base(pass.end)) {
    pass.rests_at_end = SingularSet::kNone;
  }
  if (!fit_first(pass, rest_turn, reference)) return false;
  if (pass.at == SingularSet::kWristAndShoulder && !fit_roll(pass, reference)) return false;
  reference_ = reference;
  return true;
}

double PassFit::distance_at(Singularity at, double u) const noexcept {
  return singular_distance(task_.model, task_.tool_length_mm, at,
                           pose_of<double>(task_.spans.span_at(u), u), range_.branch,
                           range_.joints);
}

bool PassFit::is_over_base(double u) const noexcept {
  return distance_at(Singularity::kShoulder, u) < kOnPoleTolerances * task_.tip_tolerance_mm;
}

bool PassFit::is_beside_both(double u) const noexcept {
  return distance_at(Singularity::kShoulder, u) < task_.tip_tolerance_mm &&
         distance_at(Singularity::kWrist, u) < task_.axis_tolerance_rad;
}

Solution<Jet<2>> PassFit::exactly(double u, int branch,
                                  const JointVector& reference) const noexcept {
  return solve(task_.model, task_.tool_length_mm, pose_of<Jet<2>>(task_.spans.span_at(u), u),
               branch, reference);
}

bool PassFit::fit_first(RobotPass& pass, double rest_turn, JointVector& reference) const noexcept {
  const double h = pass.end - pass.begin;
  const Singularity first = first_of(pass.at);
  const int joint = joint_of(first);
  JointEnd a{reference[joint], 0, 0};  // a start: at rest where it is
  if (!contains(range_.rests_at_from, first)) {
    const auto in = exactly(pass.begin, pass.branch_before, reference);
    if (in.status != SolveStatus::kOk) return false;
    a = end_of(in.q[joint], h);
    for (std::size_t i = 0; i < reference.size(); ++i) reference[i] = value_of(in.q[i]);
  }
  JointEnd b{a.value + 0.5 * a.rate + rest_turn, 0, 0};  // an end: comes to rest
  if (contains(pass.rests_at_end, first)) {
    keep_side(pass, first);
  } else {
    const auto out = exactly(pass.end, pass.branch_after, reference);
    if (out.status != SolveStatus::kOk) return false;
    b = end_of(out.q[joint], h);
    b.value = inside_travel(joint, b.value);
  }
  pass.joint = quintic_between(a, b);
  return is_guide(a) && is_guide(b);
}

bool PassFit::fit_roll(RobotPass& pass, const JointVector& reference) const noexcept {
  const double h = pass.end - pass.begin;
  JointEnd a{};
  if (!contains(range_.rests_at_from, Singularity::kWrist)) {
    const auto in = beside_yaw(pass, 0, pass.branch_before, reference);
    if (in.status != SolveStatus::kOk) return false;
    a = end_of(in.q[robot::kRoll], h);
  }
  // Where the path begins the roll stands. Beside both singularities it is rounded by 1e-8 rad.
  if (pass.begin <= range_.from) a.value = range_.joints[robot::kRoll];
  JointEnd b{a.value + 0.5 * a.rate, 0, 0};
  const auto out = beside_yaw(pass, 1, pass.branch_after, reference);
  if (out.status != SolveStatus::kOk) return false;
  const double angle = std::abs(std::sin(value_of(out.q[robot::kBend])));
  const double rest_share = ends_with_range(pass) ? range_.rest_share : kOnPoleTolerances;
  if ((ends_with_range(pass) || pass.rests_at_end != SingularSet::kNone) &&
      angle < rest_share * task_.axis_tolerance_rad) {
    pass.rests_at_end = pass.rests_at_end | SingularSet::kWrist;
    keep_side(pass, Singularity::kWrist);
  } else {
    b = end_of(out.q[robot::kRoll], h);
    b.value = inside_travel(robot::kRoll, b.value);
  }
  pass.roll = quintic_between(a, b);
  return is_guide(a) && is_guide(b);
}

Solution<Jet<3>> PassFit::beside_yaw(const RobotPass& pass, double share, int branch,
                                     const JointVector& reference) const noexcept {
  const double h = pass.end - pass.begin, u = share > 0 ? pass.end : pass.begin;
  return solve_driven(task_.model, task_.tool_length_mm, pose_of<Jet<3>>(task_.spans.span_at(u), u),
                      free_at(pass.joint, share, h), driven_branch(SingularSet::kShoulder, branch),
                      reference);
}

double PassFit::inside_travel(int joint, double value) const noexcept {
  const JointSpec& spec = task_.model.joints[static_cast<std::size_t>(joint)];
  return is_inside_travel(spec, value, kTravelMargin)
             ? value
             : nearest_winding_inside(value, value, spec.limits.travel_min, spec.limits.travel_max,
                                      kTravelMargin);
}

bool PassFit::follow(const Stretch& stretch, JointVector& joints) const noexcept {
  constexpr int kSteps = 48;
  for (int k = 1; k <= kSteps; ++k) {
    const double at = stretch.from + (stretch.to - stretch.from) * k / kSteps;
    const auto there = solve(task_.model, task_.tool_length_mm,
                             pose_of<double>(task_.spans.span_at(at), at), stretch.branch, joints);
    if (there.status == SolveStatus::kUnreachable) return false;
    joints = there.q;
    const bool is_out = first_joint_outside_travel(task_.model, joints, kTravelMargin) >= 0;
    if (stretch.keeps_travel && is_out) return false;
  }
  return true;
}

bool PassFit::leads_on(const RobotPass& pass) const noexcept {
  if (pass.rests_at_end != SingularSet::kNone) return true;
  JointVector joints = reference_;
  joints[joint_of(first_of(pass.at))] = pass.joint.back();
  if (pass.at == SingularSet::kWristAndShoulder) joints[robot::kRoll] = pass.roll.back();
  return follow({pass.end, range_.to, pass.branch_after, true}, joints);
}

}  // namespace meridian
