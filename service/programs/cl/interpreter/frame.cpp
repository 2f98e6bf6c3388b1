// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/frame.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace meridian::cl {
namespace {

constexpr double kFrameTolerance = 1e-3;  // three digits of a rounded direction cosine

/// Squares up axes x and y; z is their cross product, so that the frame is right-handed.
std::optional<Eigen::Matrix3d> squared_up(const Vector3& x, const Vector3& y) {
  if (!x.allFinite() || !y.allFinite()) return std::nullopt;
  if (std::abs(x.norm() - 1) > kFrameTolerance || std::abs(y.norm() - 1) > kFrameTolerance ||
      std::abs(x.dot(y)) > kFrameTolerance) {
    return std::nullopt;
  }
  const bool exact = x.squaredNorm() == 1 && y.squaredNorm() == 1 && x.dot(y) == 0;
  const Vector3 ux = exact ? x : x.normalized();
  const Vector3 uz = exact ? Vector3(x.cross(y)) : ux.cross(y).normalized();
  Eigen::Matrix3d rotation;
  rotation << ux, exact ? y : Vector3(uz.cross(ux)), uz;
  return rotation;
}

}  // namespace

Frame relative(const Frame& outer, const Frame& inner) {
  return {outer.rotation.transpose() * inner.rotation,
          outer.rotation.transpose() * (inner.origin - outer.origin)};
}

Frame compose(const Frame& outer, const Frame& inner) {
  return {outer.rotation * inner.rotation, outer.rotation * inner.origin + outer.origin};
}

bool is_identity(const Frame& frame) {
  return frame.origin.isZero(1e-9) && (frame.rotation - Eigen::Matrix3d::Identity()).isZero(1e-12);
}

std::optional<Frame> frame_from_axes(std::span<const double, 9> v) {
  const auto rotation = squared_up({v[3], v[4], v[5]}, {v[6], v[7], v[8]});
  if (!rotation) return std::nullopt;
  return Frame{*rotation, {v[0], v[1], v[2]}};
}

std::optional<Frame> frame_from_rows(std::span<const double, 12> r) {
  const Vector3 z{r[2], r[6], r[10]};
  const auto rotation = squared_up({r[0], r[4], r[8]}, {r[1], r[5], r[9]});
  if (!rotation || !z.allFinite() || (rotation->col(2) - z).norm() > 2 * kFrameTolerance) {
    return std::nullopt;  // the last test refuses left-handed (mirrored) matrices
  }
  return Frame{*rotation, {r[3], r[7], r[11]}};
}

}  // namespace meridian::cl
