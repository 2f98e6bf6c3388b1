// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/joint_pattern.hpp"

#include <cmath>
#include <functional>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/inspection.hpp"
#include "service/programs/cl/cl_writer.hpp"

namespace meridian::inspect {
namespace {

constexpr double kStroke_mm = 10, kTurn_deg = 5;
constexpr int kSteps = 20;  // a quarter of a degree each

using Put = std::function<void(const ClBlock&)>;

ClBlock rapid_to(const MachineModel& model, const JointVector& q) {
  const ToolPose pose = forward(model, model.tool_length_mm, q);
  ClBlock block;
  block.kind = BlockKind::kRapid;
  block.tip_mm = to_array(pose.tip);
  block.axis = to_array(pose.axis);
  return block;
}

void run(const MachineModel& model, const Put& put,
         const std::function<void(const JointSpec&, double)>& announce) {
  const JointVector begin = trial_joints(model);
  put(rapid_to(model, begin));
  for (int joint = 0; joint < model.joint_count; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    const JointSpec& spec = model.joints[i];
    double stroke = spec.is_rotary ? units::rad_from_deg(kTurn_deg) : kStroke_mm;
    if (!is_inside_travel(spec, begin[i] + stroke, 0)) stroke = -stroke;
    announce(spec, stroke);
    for (int step = 1; step <= 2 * kSteps; ++step) {
      JointVector q = begin;
      q[i] += stroke * (step <= kSteps ? step : 2 * kSteps - step) / kSteps;
      put(rapid_to(model, q));
    }
  }
  ClBlock end;
  end.kind = BlockKind::kEnd;
  put(end);
}

}  // namespace

std::vector<ClBlock> joint_pattern(const MachineModel& model) {
  std::vector<ClBlock> out;
  run(
      model, [&out](const ClBlock& block) { out.push_back(block); },
      [](const JointSpec&, double) {});
  return out;
}

void write_joint_pattern(const MachineModel& model, std::ostream& out) {
  cl::ClWriter writer(out, "JOINT PATTERN");
  writer.note("Each joint alone, forwards and back, of machine " + model.name);
  run(
      model, [&writer](const ClBlock& block) { writer.write(block); },
      [&writer](const JointSpec& joint, double stroke) {
        const double shown = joint.is_rotary ? units::deg_from_rad(stroke) : stroke;
        writer.note(joint.name + " by " + std::to_string(shown) +
                    (joint.is_rotary ? " deg" : " mm"));
      });
}

}  // namespace meridian::inspect
