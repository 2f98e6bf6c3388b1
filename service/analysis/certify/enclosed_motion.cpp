// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/enclosed_motion.hpp"

#include <optional>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"

namespace meridian::certify {
namespace {

[[nodiscard]] Vec3<Enclosure> tip_of(const MachineModel& model, const PathPiece& path,
                                     const Enclosure& s, const Joints<Enclosure>& q) {
  if (path.kind == PathKind::kJoint) return forward(model, path.tool_length_mm, q).tip;
  return pose_at(path, s).tip;
}

/// Whether the tool axis is as near to the pole all over the stretch as the kinematics hold the
/// redundant joint for: its solution there is that of the redundant joint at rest.
[[nodiscard]] bool is_held(const MachineModel& model, const PathPiece& path, const Enclosure& s) {
  constexpr double kHold = 0.999 * kPoleHold_rad;  // what rounds to less is held
  const int free = redundant_joint(model);
  if (free < 0) return false;
  const auto joint = static_cast<std::size_t>(free);
  if (path.joints_begin[joint] != path.joints_end[joint]) return false;  // held at another point
  const Vector3 pole = pole_direction(model);
  const Vec3<Enclosure> k = pose_at(path, s).axis;
  Interval square;
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;
    const Interval cross = k[a][0] * pole[b] - k[b][0] * pole[a];
    square = square + cross * cross;
  }
  return upper(square) < kHold * kHold;
}

/// From its value at the begin of the piece on: a quintic of a few micrometres would lose the
/// digits of its derivatives beside that value. Nothing where the differences are not exact.
[[nodiscard]] std::optional<Enclosure> driven_from_begin(const FreeQuintic& values,
                                                         const Enclosure& share) {
  const double begin = values[0];
  FreeQuintic from_begin{};
  for (std::size_t n = 0; n < from_begin.size(); ++n) {
    const double value = values[n];
    from_begin[n] = value - begin;
    const bool is_exact =
        value == 0 || begin == 0 || (value / begin > 0.51 && value / begin < 1.99);
    if (!is_exact) return std::nullopt;
  }
  return begin + quintic_at(from_begin, share);
}

/// As joints_at(), with driven joints by driven_from_begin().
[[nodiscard]] Solution<Enclosure> solve_on(const MachineModel& model, const PathPiece& path,
                                           const Enclosure& s, const JointVector& reference) {
  if (path.kind != PathKind::kSpline || !path.is_free_driven) {
    return joints_at(model, path, s, reference);
  }
  const auto free = driven_from_begin(path.free_quintic, s / path.length);
  const auto roll = driven_from_begin(path.roll_quintic, s / path.length);
  if (!free || !roll) return joints_at(model, path, s, reference);
  return solve_driven(model, path.tool_length_mm, pose_at(path, s), *free, *roll, path.branch,
                      reference);
}

}  // namespace

EnclosedMotion enclose(const MachineModel& model, const PathPiece& path, const Enclosure& s,
                       const JointVector& reference, bool wants_tip) {
  EnclosedMotion out;
  const Solution<Enclosure> at = solve_on(model, path, s, reference);
  out.is_reported = at.status == SolveStatus::kOk ||
                    (at.status == SolveStatus::kAtPole && is_held(model, path, s));
  if (!out.is_reported) return out;
  out.q = limited_of(model, at.q);
  if (!wants_tip) return out;
  const Vec3<Enclosure> tip = tip_of(model, path, s, at.q);
  for (int i = 0; i < 3; ++i) {
    const Enclosure velocity = derivative_of(tip[i]);
    out.tip_square += velocity * velocity;
  }
  return out;
}

}  // namespace meridian::certify
