// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/geometry/vector3.hpp"

namespace meridian::surface {

inline constexpr int kMaxDegree = 9;

/// What describes a NURBS patch. Points and weights stand row by row: all v of the first u, then of
/// the second. Units: mm. Frame: workpiece W.
struct NurbsNet {
  int degree_u = 3;
  int degree_v = 3;
  std::vector<double> knots_u;  ///< rows + degree_u + 1, never falling
  std::vector<double> knots_v;  ///< columns + degree_v + 1, never falling
  std::size_t rows = 0;         ///< points along u
  std::size_t columns = 0;      ///< points along v
  std::vector<Vector3> points;
  std::vector<double> weights;  ///< positive
};

/// Why a net is no surface: what is meant, what would be right.
struct NurbsFault {
  enum class Part { kDegree, kKnotsU, kKnotsV, kPoints, kWeights };
  Part part = Part::kDegree;
  std::string allowed;
  std::string remedy;
};

/// Place and derivatives by the parameters. Units: mm and mm per unit of the parameters.
struct SurfacePoint {
  Vector3 at, du, dv, duu, duv, dvv;
};

/// A rational B-spline surface, checked once and read only from then on.
///
/// Source: docs/surface.md, eq. 1.1 to 1.5. Proof: tests/unit/surface/nurbs_surface_test.cpp,
/// tests/golden/surface_golden_test.cpp.
class NurbsSurface {
 public:
  /// Refuses degrees beyond 1 to kMaxDegree, nets and knots that do not fit them, knots that fall
  /// or stand more often than their degree inside the patch (the surface would tear), weights that
  /// are not positive and numbers that are not finite.
  [[nodiscard]] static Expected<NurbsSurface, NurbsFault> create(NurbsNet net);

  /// Parameters outside the domain are taken to its nearest edge. On a knot the piece behind it
  /// counts, on the last knot the last piece: the domain is closed.
  [[nodiscard]] SurfacePoint evaluate(double u, double v) const noexcept;

  /// First and last parameter.
  [[nodiscard]] std::array<double, 2> domain_u() const noexcept;
  [[nodiscard]] std::array<double, 2> domain_v() const noexcept;
  /// Different knots inside `range`, its ends included: between two neighbours the surface is one
  /// rational polynomial.
  [[nodiscard]] std::vector<double> breaks_u(const std::array<double, 2>& range) const;
  [[nodiscard]] std::vector<double> breaks_v(const std::array<double, 2>& range) const;
  /// Length of the diagonal of the box around the control points.
  [[nodiscard]] double size_mm() const noexcept { return size_mm_; }
  [[nodiscard]] const NurbsNet& net() const noexcept { return net_; }

 private:
  explicit NurbsSurface(NurbsNet net);

  NurbsNet net_;
  double size_mm_ = 0;
};

}  // namespace meridian::surface
