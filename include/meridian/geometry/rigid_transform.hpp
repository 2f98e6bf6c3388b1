// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// The pose of a frame B in a frame A, written X_AB: what lies at p_B in B lies at
/// `rotation * p_B + origin_mm` in A, a direction d_B is `rotation * d_B`. Rotation is orthonormal.
struct RigidTransform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vector3 origin_mm = Vector3::Zero();
};

}  // namespace meridian
