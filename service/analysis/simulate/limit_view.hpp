// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/motion_port.hpp"
#include "service/analysis/simulate/held_by.hpp"
#include "service/core/planner/feed/cells/feed_limits.hpp"

namespace meridian::simulate {

/// What a place of the plan looks like to the limits. Units: mm, s.
struct LimitView {
  LimitId limit = kNoLimit;  ///< the one that is used most, see LimitMap
  /// What the path itself does there; a place that only speeds up or brakes has kRest and is_ramp,
  /// its cause lies elsewhere.
  Cause cause = Cause::kPath;
  bool is_ramp = false;
  double speed = 0;      ///< ṡ of the plan
  double change = 0;     ///< s̈ of the plan
  double tip_speed = 0;  ///< of the plan
};

/// Says which limit a plan is at, from the derivatives of the joints by the path: q̇ = q' ṡ,
/// q̈ = q' s̈ + q'' ṡ², q⃛ = q' s⃛ + 3 q'' ṡ s̈ + q''' ṡ³, against what a plan may use of them
/// (docs/motion.md, sections 3 and 8). Where the terms of q'' and q''' are the larger ones the path
/// bends, else the speed changes.
class LimitMap {
 public:
  /// Feed and velocities count from this share of what a plan may use on: below it the motion is on
  /// its way there, held by acceleration or jerk.
  static constexpr double kNearShare = 0.95;
  /// Accelerations and jerks count from this share on.
  static constexpr double kRampShare = 0.5;
  /// Nearer to the pole than this a limit of the redundant joint counts as the pole's.
  static constexpr double kPole_rad = 0.1;

  explicit LimitMap(const MachineModel& model);

  /// The position `piece_time` s into `piece` on `path`. `joints` give the windings. `feed_share`:
  /// ṡ over the one that is programmed, for feeds in inverse time; 0 where the tip's counts.
  [[nodiscard]] LimitView look(const PathPiece& path, const TimePiece& piece, double piece_time,
                               const JointVector& joints, double feed_share) const;

 private:
  const MachineModel& model_;
  RateLimits rates_;
  FeedLimits smooth_;  ///< what a smooth plan may use
};

}  // namespace meridian::simulate
