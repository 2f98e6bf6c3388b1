// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/nurbs_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "service/programs/surface/shape/spline_basis.hpp"

namespace meridian::surface {
namespace {

using Part = NurbsFault::Part;

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what;
}

std::optional<NurbsFault> fault_of_knots(Part part, const std::vector<double>& knots, int degree,
                                         std::size_t points) {
  const auto p = static_cast<std::size_t>(degree);
  if (knots.size() != points + p + 1) {
    return NurbsFault{part, counted(points + p + 1, "knots") + ": points + degree + 1",
                      "add or remove knots, or change degree or points"};
  }
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i]) || (i > 0 && knots[i] < knots[i - 1])) {
      return NurbsFault{part, "finite numbers, none smaller than the one before",
                        "look at number " + std::to_string(i + 1)};
    }
  }
  if (!(knots[p] < knots[points])) {
    return NurbsFault{
        part,
        "a domain: knot " + std::to_string(p + 1) + " below knot " + std::to_string(points + 1),
        "a patch of one piece has degree + 1 zeros, then degree + 1 ones"};
  }
  for (std::size_t i = p + 1; i < points; ++i) {
    if (knots[i] > knots[p] && knots[i] < knots[points] && knots[i + p] == knots[i]) {
      return NurbsFault{
          part,
          "inside the patch each knot at most " + std::to_string(degree) + " times, the degree",
          "knot " + std::to_string(i + 1) +
              " stands more often: the surface tears there; write two patches"};
    }
  }
  return std::nullopt;
}

std::optional<NurbsFault> fault_of(const NurbsNet& net) {
  const auto is_degree = [](int d) { return d >= 1 && d <= kMaxDegree; };
  if (!is_degree(net.degree_u) || !is_degree(net.degree_v)) {
    return NurbsFault{Part::kDegree, "1 to " + std::to_string(kMaxDegree), "3 is a cubic patch"};
  }
  const auto min_u = static_cast<std::size_t>(net.degree_u) + 1;
  const auto min_v = static_cast<std::size_t>(net.degree_v) + 1;
  if (net.rows < min_u || net.columns < min_v || net.points.size() != net.rows * net.columns) {
    return NurbsFault{Part::kPoints,
                      "at least " + counted(min_u, "rows of at least ") +
                          counted(min_v, "points, all rows of one length"),
                      "a patch needs degree + 1 points either way"};
  }
  if (!std::all_of(net.points.begin(), net.points.end(),
                   [](const Vector3& p) { return p.allFinite(); })) {
    return NurbsFault{Part::kPoints, "finite numbers", "mend the number"};
  }
  if (net.weights.size() != net.points.size() ||
      !std::all_of(net.weights.begin(), net.weights.end(),
                   [](double w) { return std::isfinite(w) && w > 0; })) {
    return NurbsFault{Part::kWeights, "one positive number for each point",
                      "a weight of zero takes its point away; 1 is a plain B-spline"};
  }
  if (auto fault = fault_of_knots(Part::kKnotsU, net.knots_u, net.degree_u, net.rows)) return fault;
  return fault_of_knots(Part::kKnotsV, net.knots_v, net.degree_v, net.columns);
}

std::array<double, 2> domain(const std::vector<double>& knots, int degree) noexcept {
  const auto p = static_cast<std::size_t>(degree);
  return {knots[p], knots[knots.size() - 1 - p]};
}

std::vector<double> breaks(const std::vector<double>& knots, const std::array<double, 2>& range) {
  std::vector<double> out{range[0]};
  for (const double knot : knots) {
    if (knot > out.back() && knot < range[1]) out.push_back(knot);
  }
  out.push_back(range[1]);
  return out;
}

/// A point in homogeneous coordinates: place times weight, and the weight.
struct Weighted {
  Vector3 point = Vector3::Zero();
  double weight = 0;

  void add(double factor, const Vector3& p, double w) noexcept {
    point += factor * w * p;
    weight += factor * w;
  }
};

}  // namespace

Expected<NurbsSurface, NurbsFault> NurbsSurface::create(NurbsNet net) {
  if (auto fault = fault_of(net)) return tl::make_unexpected(std::move(*fault));
  return NurbsSurface(std::move(net));
}

NurbsSurface::NurbsSurface(NurbsNet net) : net_(std::move(net)) {
  Vector3 low = net_.points.front(), high = low;
  for (const Vector3& p : net_.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  size_mm_ = (high - low).norm();
}

std::array<double, 2> NurbsSurface::domain_u() const noexcept {
  return domain(net_.knots_u, net_.degree_u);
}

std::array<double, 2> NurbsSurface::domain_v() const noexcept {
  return domain(net_.knots_v, net_.degree_v);
}

std::vector<double> NurbsSurface::breaks_u(const std::array<double, 2>& range) const {
  return breaks(net_.knots_u, range);
}

std::vector<double> NurbsSurface::breaks_v(const std::array<double, 2>& range) const {
  return breaks(net_.knots_v, range);
}

SurfacePoint NurbsSurface::evaluate(double u, double v) const noexcept {
  const BasisValues bu = basis_values(net_.knots_u, net_.degree_u, u);
  const BasisValues bv = basis_values(net_.knots_v, net_.degree_v, v);
  Weighted sum[3][3];  // [order by u][order by v]
  for (std::size_t i = 0; i <= static_cast<std::size_t>(net_.degree_u); ++i) {
    for (std::size_t j = 0; j <= static_cast<std::size_t>(net_.degree_v); ++j) {
      const std::size_t at = (bu.first + i) * net_.columns + bv.first + j;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t l = 0; k + l < 3; ++l) {
          sum[k][l].add(bu.order[k][i] * bv.order[l][j], net_.points[at], net_.weights[at]);
        }
      }
    }
  }
  // Eq. 1.4: derivatives of the quotient, from the lowest order up.
  const double w = sum[0][0].weight;
  const double wu = sum[1][0].weight, wv = sum[0][1].weight;
  SurfacePoint s;
  s.at = sum[0][0].point / w;
  s.du = (sum[1][0].point - wu * s.at) / w;
  s.dv = (sum[0][1].point - wv * s.at) / w;
  s.duu = (sum[2][0].point - 2 * wu * s.du - sum[2][0].weight * s.at) / w;
  s.duv = (sum[1][1].point - wu * s.dv - wv * s.du - sum[1][1].weight * s.at) / w;
  s.dvv = (sum[0][2].point - 2 * wv * s.dv - sum[0][2].weight * s.at) / w;
  return s;
}

}  // namespace meridian::surface
