// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/pose_solutions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

constexpr double kBeyondMargin = 1e-9;
constexpr double kSameJoints = 1e-9;

bool is_same(const MachineModel& model, const JointVector& a, const JointVector& b) {
  for (int i = 0; i < model.joint_count; ++i) {
    if (!(std::abs(a[i] - b[i]) <= kSameJoints)) return false;
  }
  return true;
}

double beyond_travel(const JointSpec& joint, double value) {
  const auto outside = [&joint](double at) {
    return std::max(joint.limits.travel_min - at, at - joint.limits.travel_max);
  };
  if (!joint.is_rotary) return outside(value);
  return std::min({outside(value), outside(value - kTurn_rad), outside(value + kTurn_rad)});
}

PoseSolution looked_at(const MachineModel& model, int branch, const Solution<double>& solution) {
  PoseSolution out{.branch = branch, .q = solution.q};
  out.is_at_pole = solution.status == SolveStatus::kAtPole;
  out.measure = measure(model, out.q);
  out.outside = first_joint_outside_travel(model, out.q, kBeyondMargin);
  if (out.outside >= 0) {
    out.beyond =
        beyond_travel(limited_spec(model, out.outside), limited_value(model, out.q, out.outside));
  }
  out.keep_out = keep_out_at(model.keep_out, out.q);
  out.tip_outside = tip_axis_outside(model, model.tool_length_mm, out.q);
  return out;
}

}  // namespace

std::vector<PoseSolution> solve_all(const MachineModel& model, const ToolPose& pose) {
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) home[i] = model.joints[i].home;
  std::vector<PoseSolution> out;
  for (int branch = 0; branch < branch_count(model); ++branch) {
    auto solution = solve(model, model.tool_length_mm, pose, branch, home);
    if (solution.status == SolveStatus::kUnreachable) continue;
    wind_into_travel(model, home, solution.q);
    const bool is_known = std::any_of(out.begin(), out.end(), [&](const PoseSolution& known) {
      return is_same(model, known.q, solution.q);
    });
    if (!is_known) out.push_back(looked_at(model, branch, solution));
  }
  return out;
}

PoseSolution solution_of_joints(const MachineModel& model, const JointVector& q) {
  return looked_at(model, 0, {q, SolveStatus::kOk});
}

Windings windings_at(const MachineModel& model, const JointVector& q, int joint) {
  const JointSpec& spec = model.joints[joint];
  if (!spec.is_rotary || spec.is_endless) return {};
  const double down = (q[joint] - spec.limits.travel_min + kBeyondMargin) / kTurn_rad;
  const double up = (spec.limits.travel_max - q[joint] + kBeyondMargin) / kTurn_rad;
  return {std::max(0, static_cast<int>(std::floor(down))),
          std::max(0, static_cast<int>(std::floor(up)))};
}

std::string why_unreachable(const MachineModel& model, const ToolPose& pose) {
  if (model.family != MachineFamily::kChain) {
    return "the arm does not reach there with the tool so: the wrist would have to stand nearer or "
           "farther than the links allow";
  }
  const Vector3 axis = model.X_MW.rotation * pose.axis;
  const double lean =
      std::atan2(axis.cross(model.chain.a.axis).norm(), axis.dot(model.chain.a.axis));
  const chain::Reach reach = chain::reach(model.chain);
  return printed("the tool axis leans %.4f deg from the axis of %s; the machine has %.4f to %.4f",
                 units::deg_from_rad(lean), model.joints[model.chain.a.joint].name.c_str(),
                 units::deg_from_rad(reach.min_rad), units::deg_from_rad(reach.largest_rad));
}

}  // namespace meridian::inspect
