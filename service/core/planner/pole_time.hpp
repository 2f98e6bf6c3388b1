// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>

#include "meridian/geometry/jet.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/pole_zone.hpp"

/// How long ways beside the pole take, without regard to what lies around: the largest of |P'|/F,
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

/// Time of the exact way on one side of the core, from the reach inwards to a distance `d`, and
/// where the free joint is there: on the way in its winding is followed.
class OutsideTime {
 public:
  OutsideTime(const PoleTask& task, const PolePlace& place, double side) noexcept;

  [[nodiscard]] double to(double d) const noexcept {
    const double place = place_of(d);
    const int k = std::min(static_cast<int>(place), kNodes - 1);
    return sum_[k] + (place - k) * (sum_[k + 1] - sum_[k]);
  }
  /// The free joint not far from `d`.
  [[nodiscard]] double free_near(double d) const noexcept {
    return free_[std::min(static_cast<int>(place_of(d)), kNodes - 1)];
  }
  [[nodiscard]] double whole() const noexcept { return sum_[kNodes]; }
  [[nodiscard]] double innermost() const noexcept { return distance(kNodes); }

 private:
  static constexpr int kNodes = 64;
  static constexpr double kRatio = 0.87;  // 0.87^64 = 1.3e-4
  [[nodiscard]] double distance(int k) const noexcept { return reach_ * std::pow(kRatio, k); }
  [[nodiscard]] double place_of(double d) const noexcept {
    return std::clamp(std::log(d / reach_) / std::log(kRatio), 0.0, 1.0 * kNodes);
  }
  double reach_;
  std::array<double, kNodes + 1> sum_{};
  std::array<double, kNodes> free_{};
};

/// Time from `begin` to `end` with `zones` (ascending) and the exact way elsewhere, on `branch` as
/// far as the first of them.
[[nodiscard]] double find_time(const PoleTask& task, std::span<const PoleZone> zones, int branch,
                               double begin, double end) noexcept;

}  // namespace meridian
