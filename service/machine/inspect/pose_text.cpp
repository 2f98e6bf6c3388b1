// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/pose_solutions.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

std::string value_text(const JointSpec& joint, double value) {
  const double shown = joint.is_rotary ? units::deg_from_rad(value) : value;
  return printed("%14.6f %s", std::abs(shown) < 5e-7 ? 0.0 : shown, joint.is_rotary ? "deg" : "mm");
}

std::string windings_text(const Windings& windings) {
  std::string out;
  if (windings.down > 0) out += printed("  -%d", windings.down);
  if (windings.up > 0) out += printed("  +%d", windings.up);
  return out.empty() ? out : printed("   whole turns left in travel:%s", out.c_str());
}

std::string values_text(const MachineModel& model, const JointVector& q) {
  std::string out;
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[i];
    out += printed("  %-10s", joint.name.c_str()) + value_text(joint, q[i]) +
           windings_text(windings_at(model, q, i)) + "\n";
  }
  if (!has_stage(model)) return out;
  if (!stage::is_in_reach(model.stage, q)) return out + "  the stage does not turn so far\n";
  for (int i = model.joint_count; i < limited_count(model); ++i) {
    const JointSpec& drive = limited_spec(model, i);
    out += printed("  %-10s", drive.name.c_str()) + value_text(drive, limited_value(model, q, i)) +
           "   drive\n";
  }
  return out + printed("  dead point of the stage: %.6g mm/rad away\n",
                       std::abs(stage::determinant(model.stage, q)));
}

}  // namespace

std::string boxes_text(const PoseSolution& solution, const MachineModel& model) {
  std::string out;
  if (solution.keep_out >= 0) {
    out += printed("; INSIDE THE KEEP-OUT BOX %s", model.keep_out.name_of(solution.keep_out));
  }
  if (solution.tip_outside >= 0) {
    out += printed("; TIP OUTSIDE ITS BOX along %c", "XYZ"[solution.tip_outside]);
  }
  return out;
}

std::string to_text(const std::vector<PoseSolution>& solutions, const MachineModel& model) {
  std::string out;
  for (const PoseSolution& solution : solutions) {
    out += printed("branch %d, measure %.6g", solution.branch, solution.measure);
    if (solution.is_at_pole) out += "; singular: the redundant joint stands at home";
    if (solution.outside >= 0) {
      const JointSpec& joint = limited_spec(model, solution.outside);
      out += printed("; OUTSIDE TRAVEL: %s by %.6g %s", joint.name.c_str(),
                     joint.is_rotary ? units::deg_from_rad(solution.beyond) : solution.beyond,
                     joint.is_rotary ? "deg" : "mm");
    }
    out += boxes_text(solution, model) + "\n";
    out += values_text(model, solution.q);
  }
  return out;
}

std::string joints_text(const MachineModel& model, const JointVector& q) {
  const ToolPose pose = forward(model, model.tool_length_mm, q);
  return printed("tip   %.6f %.6f %.6f mm\naxis  %.9f %.9f %.9f\nmeasure %.6g\n", pose.tip[0],
                 pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2],
                 measure(model, q)) +
         values_text(model, q);
}

}  // namespace meridian::inspect
