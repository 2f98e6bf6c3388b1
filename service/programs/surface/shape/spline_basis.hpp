// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "service/programs/surface/shape/nurbs_surface.hpp"

namespace meridian::surface {

/// The degree + 1 basis functions that are not zero at a parameter, with two derivatives.
struct BasisValues {
  std::size_t first = 0;  ///< control point of the first of them
  std::array<std::array<double, kMaxDegree + 1>, 3> order{};  ///< value, first, second derivative
};

/// Cox and de Boor's recursion on checked knots; `t` outside the domain is taken to its edge, and
/// the last piece is closed at its end. Source: docs/surface.md, eq. 1.2 and 1.3.
[[nodiscard]] BasisValues basis_values(const std::vector<double>& knots, int degree,
                                       double t) noexcept;

}  // namespace meridian::surface
