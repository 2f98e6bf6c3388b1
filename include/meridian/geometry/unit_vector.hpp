// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// A direction: a vector of length 1 within rounding, normalised on the way in or refused.
class UnitVector3 {
 public:
  /// The tool axis of a three-axis part: +z.
  UnitVector3() noexcept : vector_(0, 0, 1) {}

  /// Returns `vector` over its length, or nothing where a component is not finite or the length is
  /// farther than `tolerance` from 1. The check of a peer's tool axis uses 1e-3.
  /// Proof: tests/unit/geometry/unit_vector_test.cpp.
  [[nodiscard]] static std::optional<UnitVector3> near_unit(const Vector3& vector,
                                                            double tolerance = 1e-3) noexcept {
    const double length = vector.norm();
    if (!(std::abs(length - 1.0) <= tolerance)) return std::nullopt;
    return UnitVector3(vector / length);
  }

  /// Returns the direction of any finite vector that is not zero.
  [[nodiscard]] static std::optional<UnitVector3> along(const Vector3& vector) noexcept {
    const double length = vector.stableNorm();
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    return UnitVector3(vector / length);
  }

  [[nodiscard]] const Vector3& vector() const noexcept { return vector_; }

 private:
  explicit UnitVector3(const Vector3& unit) noexcept : vector_(unit) {}

  Vector3 vector_;
};

}  // namespace meridian
