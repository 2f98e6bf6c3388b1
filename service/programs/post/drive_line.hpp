// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"

namespace meridian::post {

/// What the joints do while every drive runs evenly from one point to another: the largest of the
/// first and second derivative of each by the share of the way, which runs from 0 to 1. Units: mm,
/// rad.
struct DriveLine {
  JointVector rate{};
  JointVector bend{};     ///< zero without a stage
  bool is_known = false;  ///< false: too long a way of a stage for a bound
};

/// Bounds of the way between the drive coordinates `from` and `to`.
///
/// A joint with a drive of its own runs evenly. Behind a stage the sliders are u_i = s + f_i(φ), so
/// that with g = f2 - f1, whose derivative is the stage's determinant,
///
///     φ' = (Δu2 - Δu1)/g'    φ'' = -g'' φ'²/g'    s'' = -f1'' φ'² - f1' φ''
///
/// with |g'| >= the smaller at both ends less max |g''| |Δφ|/2, and f' and f'' at their largest
/// within the stage's turn. Source: docs/postprocessor.md. Proof: tests/unit/post.
[[nodiscard]] DriveLine bound_drive_line(const MachineModel& model, const JointVector& from,
                                         const JointVector& to) noexcept;

}  // namespace meridian::post
