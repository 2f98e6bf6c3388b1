// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/limit_view.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/time_law.hpp"

namespace meridian::simulate {
namespace {

/// Where curvature alone takes this share of an acceleration or jerk, the path bends.
constexpr double kBendShare = 0.1;

/// The parts of one joint's motion.
struct Parts {
  double velocity = 0;
  double accel_change = 0, accel_bend = 0;
  double jerk_change = 0, jerk_bend = 0;
};

[[nodiscard]] Parts parts_of(const Jet<3>& q, const PathState& p) {
  const double d1 = q.derivative(1), d2 = q.derivative(2), d3 = q.derivative(3);
  return {d1 * p.ds, d1 * p.dds, d2 * p.ds * p.ds, d1 * p.ddds,
          3 * d2 * p.ds * p.dds + d3 * p.ds * p.ds * p.ds};
}

}  // namespace

LimitMap::LimitMap(const MachineModel& model)
    : model_(model),
      rates_(rate_limits(model.override_ramp_s)),
      smooth_(make_feed_limits(model, {rates_.slope_per_s, rates_.curvature_per_s2})) {}

LimitView LimitMap::look(const PathPiece& path, const TimePiece& piece, double piece_time,
                         const JointVector& joints, double feed_share) const {
  LimitView view;
  const PathState p = state_at(piece, std::min(piece_time, piece.duration));
  view.speed = p.ds;
  view.change = p.dds;
  double largest = 0, bend = 0;
  if (path.kind != PathKind::kJoint) {
    const auto pose = pose_at(path, Jet<1>::variable(p.s));
    double tip = 0;
    for (int i = 0; i < 3; ++i) tip += std::pow(pose.tip[i].derivative(1), 2);
    view.tip_speed = std::sqrt(tip) * p.ds;
  }
  const double share = feed_share > 0 || piece.feed_mm_per_s == 0
                           ? feed_share / piece.feed_factor
                           : view.tip_speed / (piece.feed_factor * piece.feed_mm_per_s);
  const auto weigh = [&](double use, double min, LimitId id) {
    if (!(use > min) || !(use > largest)) return false;
    largest = use;
    view.limit = id;
    return true;
  };
  (void)weigh(share, kNearShare, kFeedLimit);
  const auto at = joints_at(model_, path, Jet<3>::variable(p.s), joints);
  if (at.status == SolveStatus::kUnreachable) return view;
  const Limited<Jet<3>> all = limited_of(model_, at.q);
  const bool is_smooth = path.kind == PathKind::kSpline;
  bool is_bent = false;
  for (int i = 0; i < limited_count(model_); ++i) {
    const Parts parts = parts_of(all[static_cast<std::size_t>(i)], p);
    const JointLimits& own = limited_spec(model_, i).limits;
    const double velocity = std::abs(parts.velocity);
    const double accel = std::abs(parts.accel_change + parts.accel_bend);
    const double jerk = std::abs(parts.jerk_change + parts.jerk_bend);
    const auto n = static_cast<std::size_t>(i);
    const double slope = is_smooth ? rates_.slope_per_s : kRateSlope_per_s;
    const double curvature = is_smooth ? rates_.curvature_per_s2 : kRateCurvature_per_s2;
    const double accel_used = RateRoom::of_acceleration(slope, curvature).largest(accel, velocity);
    const double jerk_used =
        RateRoom::of_jerk(slope, curvature).largest(jerk, 3 * accel) + curvature * velocity;
    const double uses[3] = {velocity / (is_smooth ? smooth_.velocity[n] : own.velocity),
                            accel_used / (is_smooth ? smooth_.acceleration[n] : own.acceleration),
                            jerk_used / own.jerk};
    for (int order = 0; order < 3; ++order) {
      if (!weigh(uses[order], order == 0 ? kNearShare : kRampShare, joint_limit(i, order)))
        continue;
      is_bent = order == 1   ? std::abs(parts.accel_bend) > std::abs(parts.accel_change)
                : order == 2 ? std::abs(parts.jerk_bend) > std::abs(parts.jerk_change)
                             : false;
    }
    bend = std::max({bend, std::abs(parts.accel_bend) / own.acceleration,
                     std::abs(parts.jerk_bend) / own.jerk});
  }
  const int joint = joint_of(view.limit);
  const bool is_beside_pole = joint >= 0 && joint == redundant_joint(model_) &&
                              path.kind != PathKind::kJoint &&
                              pole_distance(model_, pose_at(path, p.s).axis) < kPole_rad;
  if (view.limit == kFeedLimit) {
    view.cause = Cause::kFeed;
  } else if (is_beside_pole) {
    view.cause = Cause::kPole;
  } else if (joint >= 0 && order_of(view.limit) == 0) {
    view.cause = Cause::kPath;
  } else if (is_bent) {
    view.cause = Cause::kBend;
  } else {
    view.is_ramp = true;
    view.cause = bend > kBendShare ? Cause::kBend : Cause::kPath;
  }
  return view;
}

}  // namespace meridian::simulate
