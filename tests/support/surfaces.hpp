// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "service/programs/surface/shape/nurbs_surface.hpp"

/// Surfaces whose shape is known, for tests.
namespace meridian::test {

/// The checked surface; ends the test program where the net is none.
[[nodiscard]] inline surface::NurbsSurface surface_of(surface::NurbsNet net) {
  auto made = surface::NurbsSurface::create(std::move(net));
  if (!made) std::abort();
  return std::move(*made);
}

/// The rectangle [0, x] x [0, y] in z = 0; u along x, normal z.
[[nodiscard]] inline surface::NurbsNet plane(double x_mm, double y_mm) {
  return {1,
          1,
          {0, 0, 1, 1},
          {0, 0, 1, 1},
          2,
          2,
          {{0, 0, 0}, {0, y_mm, 0}, {x_mm, 0, 0}, {x_mm, y_mm, 0}},
          {1, 1, 1, 1}};
}

/// A quarter of a cylinder about y: u from the x axis up to the z axis, v along y. du x dv points
/// to the axis.
[[nodiscard]] inline surface::NurbsNet cylinder(double radius_mm, double length_mm) {
  surface::NurbsNet net{2, 1, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, 3, 2, {}, {}};
  const double corner = std::sqrt(0.5);
  const double x[] = {1, 1, 0}, z[] = {0, 1, 1}, weight[] = {1, corner, 1};
  for (int i = 0; i < 3; ++i) {
    for (const double y : {0.0, length_mm}) {
      net.points.emplace_back(radius_mm * x[i], y, radius_mm * z[i]);
      net.weights.push_back(weight[i]);
    }
  }
  return net;
}

/// An eighth of a sphere: u from the equator to the pole at (0, 0, radius), v from x to y. du x dv
/// points to the middle. The edge u = 1 is one point.
[[nodiscard]] inline surface::NurbsNet sphere(double radius_mm) {
  surface::NurbsNet net{2, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}, 3, 3, {}, {}};
  const double corner = std::sqrt(0.5);
  const double out[] = {1, 1, 0}, up[] = {0, 1, 1}, x[] = {1, 1, 0}, y[] = {0, 1, 1};
  const double weight[] = {1, corner, 1};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      net.points.emplace_back(radius_mm * out[i] * x[j], radius_mm * out[i] * y[j],
                              radius_mm * up[i]);
      net.weights.push_back(weight[i] * weight[j]);
    }
  }
  return net;
}

/// A wavy patch of random degrees, knots and weights, 30 mm between control points.
[[nodiscard]] inline surface::NurbsNet wavy(std::mt19937_64& draw) {
  std::uniform_int_distribution<int> degree(2, 4), more(0, 4);
  std::uniform_real_distribution<double> height(-15, 15), weight(0.5, 2), gap(0.2, 1);
  surface::NurbsNet net;
  net.degree_u = degree(draw);
  net.degree_v = degree(draw);
  net.rows = static_cast<std::size_t>(net.degree_u + 1 + more(draw));
  net.columns = static_cast<std::size_t>(net.degree_v + 1 + more(draw));
  const auto knots = [&](int p, std::size_t points) {
    std::vector<double> out(static_cast<std::size_t>(p) + 1, 0.0);
    while (out.size() < points) out.push_back(out.back() + gap(draw));
    out.insert(out.end(), static_cast<std::size_t>(p) + 1, out.back() + gap(draw));
    return out;
  };
  net.knots_u = knots(net.degree_u, net.rows);
  net.knots_v = knots(net.degree_v, net.columns);
  for (std::size_t i = 0; i < net.rows; ++i) {
    for (std::size_t j = 0; j < net.columns; ++j) {
      net.points.emplace_back(30.0 * static_cast<double>(i), 30.0 * static_cast<double>(j),
                              height(draw));
      net.weights.push_back(weight(draw));
    }
  }
  return net;
}

}  // namespace meridian::test
