// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/programs/cl/cl_points.hpp"

/// The path that CL blocks mean, computed from the blocks alone: a check of what was made of them.
namespace meridian::test {

/// Way of one motion block. Units: mm, rad.
struct ClPath {
  ToolPose begin, end;
  ClBlock block;

  [[nodiscard]] ToolPose at(double share) const {
    const Vector3 axis = cl::turn_towards(begin.axis, end.axis, share);
    if (!block.is_arc) return {begin.tip + share * (end.tip - begin.tip), axis};
    const Vector3 centre = to_vector(block.centre_mm), normal = to_vector(block.normal);
    const Vector3 arm = begin.tip - centre;
    const Vector3 rise = normal * normal.dot(arm), x = arm - rise;
    const double angle = share * block.sweep_rad;
    const Vector3 ideal = centre + std::cos(angle) * x + std::sin(angle) * normal.cross(x) + rise +
                          share * normal * normal.dot(end.tip - begin.tip);
    const Vector3 last = centre + std::cos(block.sweep_rad) * x +
                         std::sin(block.sweep_rad) * normal.cross(x) + rise +
                         normal * normal.dot(end.tip - begin.tip);
    return {ideal + share * (end.tip - last), axis};  // what the rounded centre leaves open
  }

  [[nodiscard]] double length() const { return cl::tip_length(begin.tip, block); }
};

[[nodiscard]] inline double angle_of(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// How far `pose` is from the way, in tolerances: the least, over the way, of the larger of tip and
/// axis deviation, each in its tolerance. 1 is just allowed.
[[nodiscard]] inline double deviation(const ClPath& path, const ToolPose& pose, double tip_mm,
                                      double axis_rad) {
  const auto off = [&](double share) {
    const ToolPose at = path.at(share);
    return std::max((pose.tip - at.tip).norm() / tip_mm, angle_of(pose.axis, at.axis) / axis_rad);
  };
  constexpr int kSamples = 16;
  double best = 0, min = off(0);
  for (int n = 1; n <= kSamples; ++n) {
    const double share = static_cast<double>(n) / kSamples;
    if (const double here = off(share); here < min) {
      min = here;
      best = share;
    }
  }
  double low = std::max(0.0, best - 1.0 / kSamples), high = std::min(1.0, best + 1.0 / kSamples);
  for (int n = 0; n < 40 && high - low > 1e-9; ++n) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (off(a) < off(b) ? high : low) = off(a) < off(b) ? b : a;
  }
  return std::min(min, off((low + high) / 2));
}

/// The ways of the motion blocks after the first, which only says where the path begins.
[[nodiscard]] inline std::vector<ClPath> paths_of(const std::vector<ClBlock>& blocks) {
  std::vector<ClPath> paths;
  ToolPose last{Vector3::Zero(), Vector3::UnitZ()};
  bool has_last = false;
  for (const ClBlock& block : blocks) {
    if (!is_motion(block.kind)) continue;
    const ToolPose end{to_vector(block.tip_mm), to_vector(block.axis).normalized()};
    if (has_last) paths.push_back({last, end, block});
    last = end;
    has_last = true;
  }
  return paths;
}

}  // namespace meridian::test
