// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "meridian/geometry/vector3.hpp"

namespace meridian::surface {

/// A point of a surface with its derivatives by the parameters.
struct SurfaceJet {
  Vector3 point, u, v, uu, uv, vv;
};

/// What a cutter feels of the surface at a point. Curvature is positive where the surface bends
/// towards the normal (concave seen from the tool), 1/mm.
struct SurfaceShape {
  Vector3 point, normal;
  double least_curvature, largest_curvature;
};

/// Rational tensor-product B-spline surface (NURBS), closed on [first, last] knot of either way.
/// Source: docs/kinematics.md, chapter 6; Sarraji eq. 3 and 5, corrected.
class NurbsSurface {
 public:
  /// `points(i, j)` with weights, i along u and j along v, row by row: point i * count_v + j.
  /// Throws std::invalid_argument where counts, degrees, knots and weights do not fit together.
  NurbsSurface(int degree_u, int degree_v, std::vector<double> knots_u, std::vector<double> knots_v,
               std::vector<Eigen::Vector4d> points);

  /// Point and derivatives at (u, v); parameters outside the knots count as at the border.
  [[nodiscard]] SurfaceJet jet(double u, double v) const;

  /// Point, unit normal along Su × Sv and principal curvatures.
  /// Throws std::domain_error where the surface has no normal.
  [[nodiscard]] SurfaceShape shape(double u, double v) const;

  [[nodiscard]] double first_u() const { return knots_u_[degree_u_]; }
  [[nodiscard]] double last_u() const { return knots_u_[knots_u_.size() - 1 - degree_u_]; }
  [[nodiscard]] double first_v() const { return knots_v_[degree_v_]; }
  [[nodiscard]] double last_v() const { return knots_v_[knots_v_.size() - 1 - degree_v_]; }

 private:
  int degree_u_, degree_v_;
  std::vector<double> knots_u_, knots_v_;
  std::vector<Eigen::Vector4d> points_;  ///< homogeneous: (w x, w y, w z, w)
  int count_v_;
};

}  // namespace meridian::surface
