// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/drive_line.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/stage.hpp"

namespace meridian::post {
namespace {

/// Largest second derivative of either slider by the stage's turn, within its range: mm/rad².
[[nodiscard]] double largest_bend(const ActuatorStage& g) noexcept {
  const double sine = std::sin(g.phi_max_rad), cosine = std::cos(g.phi_max_rad);
  if (g.kind == StageKind::kPinSlot) return 2 * g.rail_mm * sine / (cosine * cosine * cosine);
  const double r = g.radius_mm;
  const double d = std::max(std::abs(r - g.rail_mm), std::abs(r * cosine - g.rail_mm));
  const double w = std::sqrt((g.rod_mm - d) * (g.rod_mm + d));
  // w'' = (d r cos φ - r² sin² φ)/w - (d r sin φ)²/w³
  const double slope = d * r * sine / w;
  return r * sine + (r * r * sine * sine + d * r) / w + slope * slope / w;
}

void bound_stage(const ActuatorStage& g, const JointVector& from, const JointVector& to,
                 DriveLine& out) noexcept {
  const JointVector begin = stage::joints_of(g, from), end = stage::joints_of(g, to);
  const double lever = stage::lever_mm(g), bend = largest_bend(g);
  const double turn = std::abs(end[g.rotary_joint] - begin[g.rotary_joint]);
  const double slide = std::abs(end[g.linear_joint] - begin[g.linear_joint]);
  const double apart =
      (to[g.rotary_joint] - to[g.linear_joint]) - (from[g.rotary_joint] - from[g.linear_joint]);
  const double min =
      std::min(stage::determinant(g, begin), stage::determinant(g, end)) - bend * turn;
  out.is_known = min > 0;
  if (!out.is_known) return;
  const double turn_rate = std::abs(apart) / min;
  const double turn_bend = 2 * bend * turn_rate * turn_rate / min;
  const double slide_bend = bend * turn_rate * turn_rate + lever * turn_bend;
  out.rate[g.rotary_joint] = turn_rate;
  out.bend[g.rotary_joint] = turn_bend;
  out.rate[g.linear_joint] = slide + slide_bend;  // somewhere it is the mean
  out.bend[g.linear_joint] = slide_bend;
}

}  // namespace

DriveLine bound_drive_line(const MachineModel& model, const JointVector& from,
                           const JointVector& to) noexcept {
  DriveLine out;
  out.is_known = true;
  for (int i = 0; i < model.joint_count; ++i) out.rate[i] = std::abs(to[i] - from[i]);
  if (has_stage(model)) bound_stage(model.stage, from, to, out);
  return out;
}

}  // namespace meridian::post
