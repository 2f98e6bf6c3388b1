// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// How far `p` is from the straight line between `a` and `b`, their ends included. Units: of the
/// points. Real-time safe. Proof: tests/unit/geometry/segment_test.cpp.
[[nodiscard]] inline double distance_to_segment(const Vector3& p, const Vector3& a,
                                                const Vector3& b) noexcept {
  const Vector3 along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0 ? std::clamp(along.dot(p - a) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

}  // namespace meridian
