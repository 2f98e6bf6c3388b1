// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"

namespace meridian {
namespace {

/// Of what the curvature alone would allow: b' and b'' may make up for some of it.
constexpr double kMakeUp = 4;

double speed_square(const Vec3<Jet<3>>& x) noexcept {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += square(x[i].derivative(1));
  return sum;
}

/// The joints at one place and how fast tip and axis are there, by u.
struct SplineSample {
  Solution<Jet<3>> joints;
  double tip_square = 0, turn_square = 0;
};

SplineSample sample_on_spline(const MachineModel& model, const FeedSpan& span, double x,
                              const JointVector& reference) noexcept {
  const PathPiece& path = span.path;
  const auto pose = pose_on(path.spline, Jet<3>::variable(x));
  SplineSample out;
  out.joints = path.is_free_driven
                   ? joints_on_driven_spline(model, path, pose, Jet<3>::variable(x), reference)
                   : solve(model, path.tool_length_mm, pose, path.branch, reference);
  out.tip_square = speed_square(pose.tip);
  if (std::isfinite(span.turn_rad_per_s) && out.joints.status != SolveStatus::kUnreachable) {
    out.turn_square = speed_square(
        path.is_free_driven ? forward(model, path.tool_length_mm, out.joints.q).axis : pose.axis);
  }
  return out;
}

SplineSample sample_on(const MachineModel& model, const FeedSpan& span, double x,
                       const JointVector& reference) noexcept {
  const PathPiece& path = span.path;
  if (path.kind == PathKind::kSpline) return sample_on_spline(model, span, x, reference);
  const double share_rate = fraction_at(path, Jet<1>::variable(x)).derivative(1);
  return {joints_at(model, path, Jet<3>::variable(x), reference),
          square(tip_length(path) * share_rate), square(path.axis_turn * share_rate)};
}

}  // namespace

PathFault take_sample(const MachineModel& model, const FeedLimits& limits, double feed_share,
                      const FeedSpan& span, double x, JointVector& reference,
                      CellSample& out) noexcept {
  const auto [at, tip_square, turn_square] = sample_on(model, span, x, reference);
  if (at.status == SolveStatus::kUnreachable) return {PathFault::Kind::kUnreachable, -1, 0};
  const double share = square(feed_share);
  double b = std::min(1 / kZeroDerivative, share * square(span.u_speed_mm_per_s));
  b = std::min(b,
               share * square(span.feed_mm_per_s) / std::max(tip_square, square(kZeroDerivative)));
  if (std::isfinite(span.turn_rad_per_s)) {
    b = std::min(
        b, share * square(span.turn_rad_per_s) / std::max(turn_square, square(kZeroDerivative)));
  }
  double jerk_per_d3 = std::numeric_limits<double>::infinity();
  const auto take = [&](int i, const Jet<3>& q) {
    const double d1 = out.d1[i] = q.derivative(1);
    const double d2 = out.d2[i] = q.derivative(2);
    const double d3 = out.d3[i] = q.derivative(3);
    b = std::min(b, square(limits.velocity[i] / std::max(std::abs(d1), kZeroDerivative)));
    b = std::min(b, kMakeUp * limits.acceleration[i] / std::max(std::abs(d2), kZeroDerivative));
    jerk_per_d3 = std::min(jerk_per_d3, limits.jerk[i] / std::max(std::abs(d3), kZeroDerivative));
  };
  for (int i = 0; i < model.joint_count; ++i) {
    reference[i] = value_of(at.q[i]);
    take(i, at.q[i]);
  }
  if (has_stage(model)) {
    const Limited<Jet<3>> all = limited_of(model, at.q);
    for (int i = model.joint_count; i < limits.count; ++i) take(i, all[i]);
  }
  b = std::min(b, kMakeUp * std::pow(jerk_per_d3, 2.0 / 3.0));
  if (!std::isfinite(b)) return {PathFault::Kind::kUnreachable, -1, 0};
  out.max_b = b;
  return {};
}

double time_per_u(const FeedLimits& limits, const CellSample& at) noexcept {
  double slowest = 1 / std::sqrt(at.max_b);
  for (int i = 0; i < limits.count; ++i) {
    slowest = std::max({slowest, std::abs(at.d1[i]) / limits.velocity[i],
                        std::sqrt(std::abs(at.d2[i]) / limits.acceleration[i]),
                        kCurvatureShare * std::cbrt(std::abs(at.d3[i]) / limits.jerk[i])});
  }
  return slowest;
}

}  // namespace meridian
