// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/placing.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

double shown(const JointSpec& joint, double value) {
  return joint.is_rotary ? units::deg_from_rad(value) : value;
}

std::string reason_of(const Fit& fit, const MachineModel& model) {
  if (fit.joint < 0) {
    return printed("line %u is out of reach, and with it %.1f %% of the program", fit.line,
                   -100 * (fit.margin + 1));
  }
  const JointSpec& joint = limited_spec(model, fit.joint);
  const char* const unit = joint.is_rotary ? "deg" : "mm";
  const double low = joint.limits.travel_min, high = joint.limits.travel_max;
  const double below = fit.least[fit.joint] - low, above = high - fit.most[fit.joint];
  const double room = shown(joint, std::min(below, above));
  return printed(room < 0 ? "%s goes %.3f %s beyond its travel in line %u"
                          : "%s comes within %.3f %s of its travel's end in line %u",
                 joint.name.c_str(), std::abs(room), unit, fit.line);
}

}  // namespace

std::string frame_text(const MachineModel& placed_model) {
  // Rz(c) Ry(b) Rx(a), as config::rotation_from_deg() makes it.
  const Eigen::Matrix3d& r = placed_model.frame_rotation;
  const double b = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  const bool is_upright = std::hypot(r(0, 0), r(1, 0)) > 1e-9;
  const double a = is_upright ? std::atan2(r(2, 1), r(2, 2)) : std::atan2(-r(1, 2), r(1, 1));
  const double c = is_upright ? std::atan2(r(1, 0), r(0, 0)) : 0;
  const Vector3& o = placed_model.frame_origin_mm;
  const auto deg = [](double rad) {
    const double value = units::deg_from_rad(rad);
    return std::abs(value) < 5e-7 ? 0.0 : value;
  };
  return printed("%.3f,%.3f,%.3f,%.6f,%.6f,%.6f", o.x(), o.y(), o.z(), deg(a), deg(b), deg(c));
}

std::string to_text(const Placing& placing, const MachineModel& model) {
  const Fit& fit = placing.fit;
  const std::string frame = frame_text(placed(model, placing.origin_mm, placing.turn_rad));
  std::string out;
  if (fit.margin < 0) {
    out +=
        printed("fits       nowhere in this box, of %d frames that were tried\n", placing.frames);
    out += "nearest    --frame " + frame + "\n";
    return out + "in the way " + reason_of(fit, model) + "\n";
  }
  out += "fits       --frame " + frame + "\n";
  out += printed("margin     %.1f %% of half the travel: ", 100 * fit.margin) +
         reason_of(fit, model) + "\n";
  for (int i = 0; i < limited_count(model); ++i) {
    const JointSpec& joint = limited_spec(model, i);
    out += printed("%-10s %.3f .. %.3f %s", joint.name.c_str(), shown(joint, fit.least[i]),
                   shown(joint, fit.most[i]), joint.is_rotary ? "deg" : "mm");
    out += joint.is_endless
               ? std::string(", endless\n")
               : printed(", travel %.3f .. %.3f\n", shown(joint, joint.limits.travel_min),
                         shown(joint, joint.limits.travel_max));
  }
  return out;
}

}  // namespace meridian::inspect
