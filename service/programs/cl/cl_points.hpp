// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian::cl {

/// A point of the plain path: where a straight piece of it ends. Units: mm, mm/s; frame: W.
struct ClPoint {
  Vector3 tip = Vector3::Zero();
  Vector3 axis = Vector3::UnitZ();
  double feed_mm_per_s = 0;  ///< tip feed allowed on the way here; 0: rapid, or the tip rests
  std::uint32_t line = 0;
  std::uint64_t sequence = 0;
};

/// How far a chord may lie from its arc in the plain path, mm.
inline constexpr double kChordError_mm = 1e-4;

/// `turned` radians from `from` along the great circle towards `to`. Angle between them below π.
[[nodiscard]] inline Vector3 turn_towards(const Vector3& from, const Vector3& to, double part) {
  const Vector3 across = from.cross(to);
  const double angle = std::atan2(across.norm(), from.dot(to));
  if (angle < 1e-12) return to;
  const Vector3 side = across.cross(from).normalized();
  return std::cos(part * angle) * from + std::sin(part * angle) * side;
}

/// Length of the tip's path in a motion block that begins at `begin`.
[[nodiscard]] inline double tip_length(const Vector3& begin, const ClBlock& block) {
  if (!block.is_arc) return (to_vector(block.tip_mm) - begin).norm();
  const Vector3 arm = begin - to_vector(block.centre_mm);
  const double rise = to_vector(block.normal).dot(to_vector(block.tip_mm) - begin);
  return std::hypot(arm.norm() * block.sweep_rad, rise);
}

/// Cuts CL blocks into the plain path: lines as they are, arcs as chords.
///
/// Inverse-time feed comes out as the tip feed that takes the block's time. Blocks without motion
/// give no point. The first motion block gives its end alone, as nothing is before it.
class PointWalker {
 public:
  explicit PointWalker(double chord_error_mm = kChordError_mm) : chord_error_(chord_error_mm) {}

  /// Calls `give(const ClPoint&)` for every point of the block, its end last.
  template <class Give>
  void walk(const ClBlock& block, Give&& give) {
    if (!is_motion(block.kind)) return;
    ClPoint end{to_vector(block.tip_mm), to_vector(block.axis), 0, block.line, block.sequence};
    if (block.feed_meaning == FeedMeaning::kTip) end.feed_mm_per_s = block.feed;
    if (has_last_) {
      if (block.feed_meaning == FeedMeaning::kInverseTime) {
        end.feed_mm_per_s = tip_length(last_.tip, block) * block.feed;
      }
      if (block.is_arc) chords(block, end, give);
    }
    give(end);
    last_ = end;
    has_last_ = true;
  }

 private:
  template <class Give>
  void chords(const ClBlock& block, const ClPoint& end, Give& give) const {
    const Vector3 centre = to_vector(block.centre_mm);
    const Vector3 normal = to_vector(block.normal);
    const Vector3 x = last_.tip - centre;
    const Vector3 y = normal.cross(x);
    const Vector3 rise = normal * normal.dot(end.tip - last_.tip);
    const double radius = x.norm();
    const double step = 2 * std::acos(std::max(1 - chord_error_ / radius, -1.0));
    const auto count = static_cast<std::int64_t>(std::ceil(block.sweep_rad / step));
    for (std::int64_t i = 1; i < count; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(count);
      const double angle = part * block.sweep_rad;
      ClPoint point = end;
      point.tip = centre + std::cos(angle) * x + std::sin(angle) * y + part * rise;
      point.axis = turn_towards(last_.axis, end.axis, part);
      give(point);
    }
  }

  double chord_error_;
  ClPoint last_;
  bool has_last_ = false;
};

/// One block on its own: `begin` is the pose where the block before it ended.
template <class Give>
void for_each_point(const ToolPose& begin, const ClBlock& block, double chord_error_mm,
                    Give&& give) {
  PointWalker walker(chord_error_mm);
  ClBlock before;
  before.kind = BlockKind::kRapid;
  before.tip_mm = to_array(begin.tip);
  before.axis = to_array(begin.axis);
  walker.walk(before, [](const ClPoint&) {});
  walker.walk(block, give);
}

}  // namespace meridian::cl
