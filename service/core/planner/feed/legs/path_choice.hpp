// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/profile.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"

/// From limits of the joints to limits of the path length, and the fastest motion inside them.
/// For every joint, with bounds q', q'', q''' of its derivatives by s:
///
///     q' V <= v,   q'' V² + q' A <= a,   q''' V³ + 3 q'' V A + q' J <= j
///
/// Units: mm, rad, s. Source: docs/motion.md.
namespace meridian {

/// Limits that a motion may use: of the joints, then of the drives of the stage.
struct JointCaps {
  LimitedVector velocity{}, acceleration{}, jerk{};
  LimitedVector noise_gain{};  ///< jerk that differences of setpoints show per rad of joint noise
  int count = 0;
};

/// Share of each limit that is planned, and that a stop uses.
inline constexpr double kPlannedShare = 0.99;

[[nodiscard]] JointCaps planned_caps(const MachineModel& model, double reach_mm) noexcept;
[[nodiscard]] JointCaps fault_caps(const MachineModel& model, double reach_mm) noexcept;

/// Largest |s̈| beside ṡ <= `velocity`, and largest |s⃛| beside both, or beside ṡ |s̈| <= `product`.
/// Not positive: none.
[[nodiscard]] double find_acceleration(std::span<const JointCell> cells, const JointCaps& caps,
                                       double velocity) noexcept;
[[nodiscard]] double find_jerk(std::span<const JointCell> cells, const JointCaps& caps,
                               double velocity, double acceleration) noexcept;

[[nodiscard]] double find_jerk_beside(std::span<const JointCell> cells, const JointCaps& caps,
                                      double velocity, double product) noexcept;

/// A motion on a piece and the limits that it was made for.
struct MotionChoice {
  PathLimits limits;
  Profile profile;  ///< jerk 0: no motion is possible
};

/// Returns the fastest rest-to-rest motion over `length` whose curvature terms leave at least
/// kAuthority of acceleration and jerk: what is left is what a stop can use. `feed_velocity` bounds
/// ṡ besides the joints.
[[nodiscard]] MotionChoice choose_motion(std::span<const JointCell> cells, const JointCaps& caps,
                                         double length, double feed_velocity) noexcept;

/// States that a stop may start from.
struct StopRange {
  double velocity = 0;      ///< largest ṡ, also while the stop lets go of s̈ > 0
  double top = 0;           ///< largest ṡ that there would be at s̈ = 0
  double acceleration = 0;  ///< largest |s̈|
  double fall = 0;          ///< largest -s̈
};

/// Authority to stop from such states.
[[nodiscard]] PathLimits find_authority(std::span<const JointCell> cells, const JointCaps& caps,
                                        const StopRange& range) noexcept;

}  // namespace meridian
