// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>

#include "meridian/geometry/jet.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/singular/pole/pole_zone.hpp"

/// How long routes beside the pole take, without regard to what lies around: the largest of |P'|/F,
/// |q'|/V, √(|q''|/A), ∛(|q'''|/J) over all joints, summed up. Units: mm, rad, s. No memory.
/// Source: docs/motion.md, section 10.
namespace meridian {

template <class S>
[[nodiscard]] Pose<S> pose_of(const BandSpan& span, double u) noexcept {
  const double x = std::clamp(u - span.u0, 0.0, span.length);
  if constexpr (std::is_same_v<S, double>) {
    return pose_on(span.c, x);
  } else {
    return pose_on(span.c, S::variable(x));
  }
}

template <class S>
[[nodiscard]] Pose<S> pose_of(const PoleTask& task, double u) noexcept {
  return pose_of<S>(task.spans.span_at(u), u);
}

/// The quintic at the share `t` of its range of length `h`, with its derivatives by u: they are
/// differences of what de Casteljau's steps leave.
[[nodiscard]] Jet<3> free_at(const FreeQuintic& values, double t, double h) noexcept;

/// Time per u at which the joints can follow, seconds per mm.
[[nodiscard]] double slowness(const MachineModel& model, const BandSpan& span,
                              const Pose<Jet<3>>& pose, const Joints<Jet<3>>& q) noexcept;

}  // namespace meridian
