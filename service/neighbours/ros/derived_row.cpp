// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/derived_row.hpp"

#include <algorithm>
#include <cmath>

namespace meridian::ros {
namespace {

[[nodiscard]] double distance(const Vec3<double>& a, const Vec3<double>& b) noexcept {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Between unit vectors; exact for small angles, where that of the cosine is not.
[[nodiscard]] double angle(const Vec3<double>& a, const Vec3<double>& b) noexcept {
  return 2 * std::asin(std::min(1.0, distance(a, b) / 2));
}

}  // namespace

void DerivedRow::add(const record::RecordingRow& row) {
  const bool is_next = has_row_ && row.cycle == cycle_ + 1;
  const Pose<double> pose = forward(model_, model_.tool_length_mm, row.joints);
  const double rate = 1e9 / static_cast<double>(model_.cycle_ns);
  feed_mm_per_s_ = is_next ? distance(pose.tip, pose_.tip) * rate : 0;
  turn_rad_per_s_ = is_next ? angle(pose.axis, pose_.axis) * rate : 0;
  pose_ = pose;
  const bool is_fault = (row.flags & kSetpointFaultStop) != 0;
  shares_.add(row.positions, is_next && is_leading(row.flags),
              is_fault ? scene::Bounds::kOfFaultStop : scene::Bounds::kOfMotion);
  has_row_ = true;
  cycle_ = row.cycle;
}

}  // namespace meridian::ros
