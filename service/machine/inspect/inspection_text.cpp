// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/inspection.hpp"
#include "service/machine/inspect/joint_unit.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

constexpr double kNothing = 1e-9;

/// Never "-0.000".
double shown(double value) { return std::abs(value) < 5e-5 ? 0.0 : value; }

std::string vector_text(const Vector3& v) {
  return printed("(%.4f, %.4f, %.4f)", shown(v[0]), shown(v[1]), shown(v[2]));
}

/// "+x" for a coordinate direction, else its numbers.
std::string direction_text(const Vector3& v) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(std::abs(v[i]) - 1) < 1e-9) return printed("%c%c", v[i] > 0 ? '+' : '-', "xyz"[i]);
  }
  return vector_text(v);
}

const JointSpec& spec_of(const MachineModel& model, int joint) {
  return model.joints[static_cast<std::size_t>(joint)];
}

const char* mover(Side side) {
  switch (side) {
    case Side::kTable:
      return "table";
    case Side::kTool:
      return "tool";
    case Side::kRelative:
      break;
  }
  return "tool, seen from the workpiece,";
}

std::string chain_text(const Inspection& in, const MachineModel& model) {
  std::string out = "chain, from the workpiece to the tool:\n  workpiece";
  for (const SkeletonJoint& joint : in.skeleton.joints) {
    out += " - " + spec_of(model, joint.joint).name;
  }
  out += " - tool\n";
  for (const SkeletonJoint& joint : in.skeleton.joints) {
    const JointSpec& spec = spec_of(model, joint.joint);
    out += printed("  %-10s ", spec.name.c_str());
    if (joint.is_rotary) {
      out += printed("+ turns the %s right-handed about %s through %s\n", mover(joint.side),
                     direction_text(joint.direction).c_str(), vector_text(joint.point).c_str());
    } else {
      out += printed("+ moves the %s towards %s\n", mover(joint.side),
                     direction_text(joint.direction).c_str());
    }
  }
  if (has_stage(model)) {
    out += "  stage      " + model.stage_drives[0].name + " and " + model.stage_drives[1].name +
           " drive " + spec_of(model, model.stage.linear_joint).name + " and " +
           spec_of(model, model.stage.rotary_joint).name + "\n";
  }
  return out;
}

std::string pose_text(const ToolPose& pose) {
  return "tip " + vector_text(pose.tip) + " mm, tool axis " + vector_text(pose.axis);
}

std::string trial_text(const Inspection& in, const MachineModel& model) {
  std::string out = "each joint alone, in the workpiece";
  if (in.trial_joints != in.home) {
    out += ", from " + pose_text(in.trial_pose) + " (home is on the pole)";
  }
  out += ":\n";
  for (const JointTrial& trial : in.trials) {
    const JointSpec& spec = spec_of(model, trial.joint);
    out += printed("  %-10s %+6.4g %-3s ", spec.name.c_str(), at_edge(spec, trial.step),
                   unit_of(spec));
    out += trial.tip_move.norm() > kNothing ? "tip by " + vector_text(trial.tip_move) + " mm"
                                            : std::string("tip stays");
    out += trial.axis_turn > kNothing
               ? printed("; axis leans %.4f deg towards %s", units::deg_from_rad(trial.axis_turn),
                         direction_text(trial.axis_towards).c_str())
               : std::string("; axis stays");
    out += "\n";
  }
  return out;
}

/// What is left in the tool axis on a pole that it misses.
std::string missed_pole_text(const MachineModel& model) {
  const double off = pole_offset_rad(model);
  if (off == 0) return "";
  return printed("the tool axis misses it by %.3g deg; ", units::deg_from_rad(std::abs(off)));
}

/// Of the two poles that an axis has, where both can be, the one nearer to home.
Vector3 nearer_pole(const Inspection& in, const MachineModel& model) {
  const Vector3 pole = pole_direction(model);
  const bool has_both = model.family == MachineFamily::kChain && model.chain.has_opposite_pole;
  return has_both && pole.dot(in.home_pose.axis) < 0 ? Vector3(-pole) : pole;
}

std::string pole_text(const Inspection& in, const MachineModel& model) {
  std::string out;
  const int free = redundant_joint(model);
  if (free < 0) {
    out = model.family == MachineFamily::kRobot
              ? "arm        the shoulder lies on the base axis, the wrist on the line of the "
                "forearm\n"
                "singular   wrist point over the base, arm stretched or folded, wrist aligned; "
              : "pole       none; ";
  } else {
    out = "pole       tool axis along " + direction_text(nearer_pole(in, model)) + ": " +
          spec_of(model, free).name + " is free there; ";
    out += missed_pole_text(model);
  }
  out += printed("measure at home %.4g%s\n", in.home_measure,
                 in.home_measure >= 1e-9 ? ""
                 : free < 0              ? " (home is singular)"
                                         : ": it is on the pole");
  return out;
}

std::string reach_text(const Inspection& in) {
  if (!in.is_origin_in_reach) return "reach      the workpiece's origin is out of reach\n";
  std::string out = printed(
      "reach      at the workpiece's origin every tool axis to %.0f deg from z; some to "
      "%.0f deg\n",
      units::deg_from_rad(in.all_tilt), units::deg_from_rad(in.some_tilt));
  out += "           from there, tool along z:";
  for (std::size_t i = 0; i < 3; ++i) {
    out += printed(" %c %.1f .. %.1f%s", "xyz"[i], shown(in.straight[i][0]),
                   shown(in.straight[i][1]), i < 2 ? "," : " mm\n");
  }
  return out;
}

std::string limits_text(const MachineModel& model) {
  std::string out =
      "limits     joint      travel                    home      velocity  acceleration          "
      "jerk\n";
  for (int i = 0; i < limited_count(model); ++i) {
    const JointSpec& joint = limited_spec(model, i);
    const JointLimits& l = joint.limits;
    const std::string travel = joint.is_endless
                                   ? "endless"
                                   : printed("%.6g .. %.6g %s", at_edge(joint, l.travel_min),
                                             at_edge(joint, l.travel_max), unit_of(joint));
    out +=
        printed("           %-10s %-22s %7.6g %10.6g/s %10.6g/s2 %10.6g/s3\n", joint.name.c_str(),
                travel.c_str(), at_edge(joint, joint.home), at_edge(joint, l.velocity),
                at_edge(joint, l.acceleration), at_edge(joint, l.jerk));
  }
  return out;
}

std::string keep_out_text(const MachineModel& model) {
  std::string out;
  for (const KeepOutBox& box : model.keep_out.boxes()) {
    out += printed("keep out   %-10s", box.name.data());
    for (int i = 0; i < model.joint_count; ++i) {
      const JointSpec& joint = limited_spec(model, i);
      const auto n = static_cast<std::size_t>(i);
      if (!box.has(i)) continue;
      out += printed(" %s %.6g .. %.6g %s", joint.name.c_str(), at_edge(joint, box.min[n]),
                     at_edge(joint, box.max[n]), unit_of(joint));
    }
    out += "\n";
  }
  return out;
}

std::string tip_box_text(const MachineModel& model) {
  const TipBox& box = model.tip_box;
  if (!box.is_set) return "";
  return printed("tip box    X %.6g .. %.6g Y %.6g .. %.6g Z %.6g .. %.6g mm over the base\n",
                 box.min[0], box.max[0], box.min[1], box.max[1], box.min[2], box.max[2]);
}

}  // namespace

std::string to_text(const Inspection& in, const MachineModel& model) {
  std::string out = "machine    " + model.name;
  out +=
      printed(", %d joints, tool of %.6g mm, workpiece at %s mm in the machine\n",
              model.joint_count, model.tool_length_mm, vector_text(model.X_MW.origin_mm).c_str());
  out += chain_text(in, model);
  out += "home       " + pose_text(in.home_pose) + " in the workpiece\n";
  out += trial_text(in, model) + pole_text(in, model) + reach_text(in) + limits_text(model);
  out += keep_out_text(model) + tip_box_text(model);
  out += printed("inverse    joints to pose and back: within %.2g mm and %.2g rad\n",
                 in.round_trip_mm, in.round_trip_axis);
  for (const std::string& fact : in.measured) out += "measured   " + fact + "\n";
  for (const std::string& warning : in.warnings) out += "WARNING    " + warning + "\n";
  if (in.warnings.empty()) out += "no warnings\n";
  return out;
}

}  // namespace meridian::inspect
