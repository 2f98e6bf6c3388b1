// SPDX-License-Identifier: Apache-2.0
#include "service/surface/nurbs_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace meridian::surface {
namespace {

constexpr int kDerivatives = 3;  // value, first, second

/// Values and two derivatives of the basis functions that are not zero at `t`, of which the first
/// belongs to control point `first`.
struct Basis {
  int first;
  std::vector<std::array<double, kDerivatives>> functions;
};

int span_of(const std::vector<double>& knots, int degree, double t) {
  const int last = static_cast<int>(knots.size()) - degree - 2;
  if (t >= knots[last + 1]) return last;
  const auto above = std::upper_bound(knots.begin() + degree, knots.begin() + last + 1, t);
  return static_cast<int>(above - knots.begin()) - 1;
}

/// Basis functions of degree `degree` on knot span `span` by the Cox-de Boor recurrence; a zero
/// over zero counts as zero.
std::vector<double> functions_of_degree(const std::vector<double>& knots, int span, int degree,
                                        double t) {
  std::vector<double> n(degree + 1, 0.0);
  n[0] = 1.0;
  for (int p = 1; p <= degree; ++p) {
    double saved = 0.0;
    for (int r = 0; r < p; ++r) {
      const double right = knots[span + r + 1], left = knots[span + 1 - p + r];
      const double part = n[r] / (right - left);
      n[r] = saved + (right - t) * part;
      saved = (t - left) * part;
    }
    n[p] = saved;
  }
  return n;
}

/// Derivative by difference: N'_{i,p} = p (N_{i,p-1}/(t_{i+p}-t_i) -
/// N_{i+1,p-1}/(t_{i+p+1}-t_{i+1})).
std::vector<double> differences(const std::vector<double>& knots, int span, int degree,
                                const std::vector<double>& lower) {
  std::vector<double> n(degree + 1, 0.0);
  const auto share = [&](int r) {  // function r of the lower degree, seen from this one
    if (r < 0 || r >= degree) return 0.0;
    const int i = span - degree + 1 + r;
    const double width = knots[i + degree] - knots[i];
    return width > 0 ? lower[r] / width : 0.0;
  };
  for (int r = 0; r <= degree; ++r) n[r] = degree * (share(r - 1) - share(r));
  return n;
}

Basis basis_of(const std::vector<double>& knots, int degree, double t) {
  const double inside =
      std::clamp(t, knots[degree], knots[knots.size() - 1 - static_cast<std::size_t>(degree)]);
  const int span = span_of(knots, degree, inside);
  Basis out{span - degree, {}};
  const auto value = functions_of_degree(knots, span, degree, inside);
  std::vector<double> first(degree + 1, 0.0), second(degree + 1, 0.0);
  if (degree >= 1) {
    first = differences(knots, span, degree, functions_of_degree(knots, span, degree - 1, inside));
  }
  if (degree >= 2) {
    const auto lower =
        differences(knots, span, degree - 1, functions_of_degree(knots, span, degree - 2, inside));
    second = differences(knots, span, degree, lower);
  }
  for (int r = 0; r <= degree; ++r) out.functions.push_back({value[r], first[r], second[r]});
  return out;
}

int checked_count(const std::vector<double>& knots, int degree, const char* way) {
  const auto refuse = [way](const std::string& why) {
    throw std::invalid_argument(std::string("knots along ") + way + ": " + why);
  };
  if (degree < 1 || degree > 9) refuse("the degree must be 1 to 9");
  const int count = static_cast<int>(knots.size()) - degree - 1;
  if (count < degree + 1) refuse("too few for the degree");
  if (!std::is_sorted(knots.begin(), knots.end())) refuse("must not fall");
  if (!(knots[degree] < knots[count])) refuse("the parameter range is empty");
  return count;
}

}  // namespace

NurbsSurface::NurbsSurface(int degree_u, int degree_v, std::vector<double> knots_u,
                           std::vector<double> knots_v, std::vector<Eigen::Vector4d> points)
    : degree_u_(degree_u),
      degree_v_(degree_v),
      knots_u_(std::move(knots_u)),
      knots_v_(std::move(knots_v)),
      points_(std::move(points)),
      count_v_(0) {
  const int count_u = checked_count(knots_u_, degree_u_, "u");
  count_v_ = checked_count(knots_v_, degree_v_, "v");
  if (points_.size() != static_cast<std::size_t>(count_u) * count_v_) {
    throw std::invalid_argument("the surface needs " + std::to_string(count_u) + " x " +
                                std::to_string(count_v_) + " control points, " +
                                std::to_string(points_.size()) + " are given");
  }
  for (Eigen::Vector4d& p : points_) {
    if (!p.allFinite() || !(p[3] > 0)) {
      throw std::invalid_argument("control points must be finite with a weight above 0");
    }
    p.head<3>() *= p[3];
  }
}

SurfaceJet NurbsSurface::jet(double u, double v) const {
  const Basis along_u = basis_of(knots_u_, degree_u_, u);
  const Basis along_v = basis_of(knots_v_, degree_v_, v);
  // homogeneous derivatives a[k][l] = d^(k+l) / du^k dv^l
  std::array<std::array<Eigen::Vector4d, kDerivatives>, kDerivatives> a;
  for (auto& row : a) row.fill(Eigen::Vector4d::Zero());
  for (int i = 0; i <= degree_u_; ++i) {
    for (int j = 0; j <= degree_v_; ++j) {
      const Eigen::Vector4d& p = points_[(along_u.first + i) * count_v_ + along_v.first + j];
      for (int k = 0; k < kDerivatives; ++k) {
        for (int l = 0; k + l < kDerivatives; ++l) {
          a[k][l] += along_u.functions[i][k] * along_v.functions[j][l] * p;
        }
      }
    }
  }
  const auto head = [&](int k, int l) -> Vector3 { return a[k][l].head<3>(); };
  const auto w = [&](int k, int l) { return a[k][l][3]; };
  SurfaceJet out;
  const double per_weight = 1.0 / w(0, 0);
  out.point = head(0, 0) * per_weight;
  out.u = (head(1, 0) - w(1, 0) * out.point) * per_weight;
  out.v = (head(0, 1) - w(0, 1) * out.point) * per_weight;
  out.uu = (head(2, 0) - 2.0 * w(1, 0) * out.u - w(2, 0) * out.point) * per_weight;
  out.vv = (head(0, 2) - 2.0 * w(0, 1) * out.v - w(0, 2) * out.point) * per_weight;
  out.uv = (head(1, 1) - w(1, 0) * out.v - w(0, 1) * out.u - w(1, 1) * out.point) * per_weight;
  return out;
}

SurfaceShape NurbsSurface::shape(double u, double v) const {
  const SurfaceJet s = jet(u, v);
  const Vector3 across = s.u.cross(s.v);
  const double area = across.norm();
  if (!(area > 1e-12 * (1.0 + s.u.squaredNorm() + s.v.squaredNorm()))) {
    throw std::domain_error("the surface has no normal at u = " + std::to_string(u) +
                            ", v = " + std::to_string(v));
  }
  const Vector3 normal = across / area;
  const double e = s.u.dot(s.u), f = s.u.dot(s.v), g = s.v.dot(s.v);
  const double l = s.uu.dot(normal), m = s.uv.dot(normal), n = s.vv.dot(normal);
  const double first = e * g - f * f;
  const double mean = 0.5 * (e * n - 2.0 * f * m + g * l) / first;
  const double gauss = (l * n - m * m) / first;
  const double spread = std::sqrt(std::max(mean * mean - gauss, 0.0));
  return {s.point, normal, mean - spread, mean + spread};
}

}  // namespace meridian::surface
