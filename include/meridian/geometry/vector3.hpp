// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace meridian {

/// Column vector of three scalars; `S` is double or a Jet.
template <class S>
using Vec3 = Eigen::Matrix<S, 3, 1>;
using Vector3 = Vec3<double>;

/// Plain storage of a vector: trivially copyable, for rings, wire and files.
using Array3 = std::array<double, 3>;

[[nodiscard]] inline Vector3 to_vector(const Array3& a) noexcept { return {a[0], a[1], a[2]}; }
[[nodiscard]] inline Array3 to_array(const Vector3& v) noexcept { return {v[0], v[1], v[2]}; }

/// A tool pose: tip position (the tool centre point, TCP, mm) and unit tool axis, from the tip
/// towards the spindle.
template <class S>
struct Pose {
  Vec3<S> tip;
  Vec3<S> axis;
};
using ToolPose = Pose<double>;

}  // namespace meridian
