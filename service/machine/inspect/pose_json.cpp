// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/pose_solutions.hpp"

namespace meridian::inspect {
namespace {

using nlohmann::ordered_json;

double edge_value(const JointSpec& joint, double value) {
  return joint.is_rotary ? units::deg_from_rad(value) : value;
}

ordered_json vector_json(const Vector3& v) { return {v[0], v[1], v[2]}; }

/// One entry a joint: its value and, where it turns, the whole turns that travel leaves.
ordered_json joint_values(const MachineModel& model, const JointVector& q) {
  ordered_json out = ordered_json::array();
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[i];
    ordered_json one = {{"name", joint.name},
                        {"unit", joint.is_rotary ? "deg" : "mm"},
                        {"value", edge_value(joint, q[i])}};
    if (joint.is_rotary && !joint.is_endless) {
      const Windings windings = windings_at(model, q, i);
      one["turns_down"] = windings.down;
      one["turns_up"] = windings.up;
    }
    out.push_back(one);
  }
  return out;
}

/// Drives of the stage and how far it is from its dead point; empty for a machine without one.
void add_stage(const MachineModel& model, const JointVector& q, ordered_json& out) {
  if (!has_stage(model) || !stage::is_in_reach(model.stage, q)) return;
  for (int i = model.joint_count; i < limited_count(model); ++i) {
    const JointSpec& drive = limited_spec(model, i);
    out["drives"].push_back({{"name", drive.name},
                             {"unit", drive.is_rotary ? "deg" : "mm"},
                             {"value", edge_value(drive, limited_value(model, q, i))}});
  }
  out["dead_point_mm_per_rad"] = std::abs(stage::determinant(model.stage, q));
}

ordered_json solution_json(const MachineModel& model, const PoseSolution& solution) {
  ordered_json out = {{"branch", solution.branch},
                      {"is_singular", solution.is_at_pole},
                      {"measure", solution.measure},
                      {"is_inside_travel", solution.outside < 0}};
  if (solution.outside >= 0) {
    const JointSpec& joint = limited_spec(model, solution.outside);
    out["outside"] = {{"joint", joint.name}, {"by", edge_value(joint, solution.beyond)}};
  }
  if (solution.keep_out >= 0) out["keep_out"] = model.keep_out.name_of(solution.keep_out);
  if (solution.tip_outside >= 0) {
    out["tip_outside"] = std::string(1, "XYZ"[solution.tip_outside]);
  }
  out["joints"] = joint_values(model, solution.q);
  add_stage(model, solution.q, out);
  return out;
}

}  // namespace

std::string to_json(const std::vector<PoseSolution>& solutions, const MachineModel& model,
                    const ToolPose& pose) {
  ordered_json out = {{"tip_mm", vector_json(pose.tip)}, {"axis", vector_json(pose.axis)}};
  out["solutions"] = ordered_json::array();
  for (const PoseSolution& one : solutions) out["solutions"].push_back(solution_json(model, one));
  if (solutions.empty()) out["out_of_reach"] = why_unreachable(model, pose);
  return out.dump(2) + "\n";
}

std::string joints_json(const MachineModel& model, const JointVector& q) {
  const ToolPose pose = forward(model, model.tool_length_mm, q);
  ordered_json out = {{"tip_mm", vector_json(pose.tip)},
                      {"axis", vector_json(pose.axis)},
                      {"measure", measure(model, q)}};
  out["joints"] = joint_values(model, q);
  add_stage(model, q, out);
  return out.dump(2) + "\n";
}

}  // namespace meridian::inspect
