// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "meridian/geometry/vector3.hpp"

namespace meridian::cl {

/// A rigid frame: a point p in it lies at `rotation * p + origin` in the frame around it.
struct Frame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vector3 origin = Vector3::Zero();

  [[nodiscard]] Vector3 point(const Vector3& p) const { return rotation * p + origin; }
  [[nodiscard]] Vector3 direction(const Vector3& d) const { return rotation * d; }
};

/// `inner` as seen from `outer`, both given in one frame around them: outer⁻¹ · inner.
[[nodiscard]] Frame relative(const Frame& outer, const Frame& inner);

/// `inner` given in `outer`, seen from around `outer`: outer · inner.
[[nodiscard]] Frame compose(const Frame& outer, const Frame& inner);

[[nodiscard]] bool is_identity(const Frame& frame);

/// MSYS of a CLSF: origin, x axis, y axis. Nothing where the axes are off square or off unit length
/// by more than 1e-3; smaller errors (rounded digits) are squared up.
[[nodiscard]] std::optional<Frame> frame_from_axes(std::span<const double, 9> origin_x_y);

/// CSYS and $$*CATIA0: three rows of four, rotation and translation. Refuses as frame_from_axes.
[[nodiscard]] std::optional<Frame> frame_from_rows(std::span<const double, 12> rows);

}  // namespace meridian::cl
