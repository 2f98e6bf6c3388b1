// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/joint_unit.hpp"
#include "service/machine/inspect/placing.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

std::string margin_text(const Fit& fit, const MachineModel& model) {
  const JointSpec& joint = limited_spec(model, fit.joint);
  const JointLimits& limits = joint.limits;
  const double room =
      std::min(fit.min[fit.joint] - limits.travel_min, limits.travel_max - fit.max[fit.joint]);
  return printed(
      "margin     %.1f %% of half the travel: %s comes within %.3f %s of its travel's "
      "end in line %u\n",
      100 * fit.margin, joint.name.c_str(), at_edge(joint, room), unit_of(joint), fit.line);
}

std::string lines_text(const FitFinding& finding) {
  if (finding.lines == 1) return printed("in line %u", finding.first_line);
  return printed("in %d lines, %u to %u", finding.lines, finding.first_line, finding.last_line);
}

std::string finding_text(const FitFinding& finding, const MachineModel& model) {
  const std::string lines = lines_text(finding);
  switch (finding.obstacle) {
    case Obstacle::kOutOfReach:
      return "the pose is out of reach " + lines;
    case Obstacle::kKeepOut:
      return printed("keep-out box %s is entered ", model.keep_out.name_of(finding.number)) + lines;
    case Obstacle::kTipBox:
      return printed("the tip goes %.3f mm out of the tip box along %c ", finding.farthest,
                     "XYZ"[finding.number]) +
             lines;
    case Obstacle::kTravelMin:
    case Obstacle::kTravelMax:
      break;
  }
  const JointSpec& joint = limited_spec(model, finding.number);
  const bool is_min = finding.obstacle == Obstacle::kTravelMin;
  const double end = is_min ? joint.limits.travel_min : joint.limits.travel_max;
  const std::string where =
      finding.lines == 1 ? "" : printed(", farthest in line %u", finding.farthest_line);
  return printed("%s goes %.3f %s beyond its end at %.3f ", joint.name.c_str(),
                 at_edge(joint, finding.farthest), unit_of(joint), at_edge(joint, end)) +
         lines + where;
}

}  // namespace

std::string frame_text(const MachineModel& placed_model) {
  // Rz(c) Ry(b) Rx(a), as config::rotation_from_deg() makes it.
  const Eigen::Matrix3d& r = placed_model.X_MW.rotation;
  const double b = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  const bool is_upright = std::hypot(r(0, 0), r(1, 0)) > 1e-9;
  const double a = is_upright ? std::atan2(r(2, 1), r(2, 2)) : std::atan2(-r(1, 2), r(1, 1));
  const double c = is_upright ? std::atan2(r(1, 0), r(0, 0)) : 0;
  const Vector3& o = placed_model.X_MW.origin_mm;
  const auto deg = [](double rad) {
    const double value = units::deg_from_rad(rad);
    return std::abs(value) < 5e-7 ? 0.0 : value;
  };
  return printed("%.3f,%.3f,%.3f,%.6f,%.6f,%.6f", o.x(), o.y(), o.z(), deg(a), deg(b), deg(c));
}

std::string to_text(const Placing& placing, const MachineModel& model,
                    const std::vector<ProgramPose>& poses) {
  const Fit& fit = placing.fit;
  const MachineModel there = placed(model, placing.origin_mm, placing.turn_rad);
  const std::string frame = frame_text(there);
  std::string out;
  if (fit.margin < 0) {
    out +=
        printed("fits       nowhere in this box, of %d frames that were tried\n", placing.frames);
    out += "nearest    --frame " + frame + "\n";
    for (const FitFinding& finding : findings_of(there, poses, fit.branch)) {
      out += "in the way " + finding_text(finding, model) + "\n";
    }
    return out;
  }
  out += "fits       --frame " + frame + "\n";
  if (fit.joint >= 0) out += margin_text(fit, model);
  for (int i = 0; i < limited_count(model); ++i) {
    const JointSpec& joint = limited_spec(model, i);
    out += printed("%-10s %.3f .. %.3f %s", joint.name.c_str(), at_edge(joint, fit.min[i]),
                   at_edge(joint, fit.max[i]), unit_of(joint));
    out += joint.is_endless
               ? std::string(", endless\n")
               : printed(", travel %.3f .. %.3f\n", at_edge(joint, joint.limits.travel_min),
                         at_edge(joint, joint.limits.travel_max));
  }
  return out;
}

}  // namespace meridian::inspect
