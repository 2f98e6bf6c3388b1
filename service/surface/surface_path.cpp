// SPDX-License-Identifier: Apache-2.0
#include "service/surface/surface_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace meridian::surface {
namespace {

constexpr int kLineSamples = 41;       // where the step to the next line is measured
constexpr int kMostPerLine = 100'000;  // a tolerance that asks for more is a mistake
constexpr int kMostLines = 100'000;

/// Parameter steps along a line are judged at these shares of a chord.
constexpr double kChordShares[] = {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875};

void check(const PathPlan& plan) {
  const auto refuse = [](const char* why) { throw std::invalid_argument(why); };
  if (!(plan.cutter.diameter_mm > 0)) refuse("the cutter's diameter must be above 0 mm");
  if (!(plan.cutter.corner_radius_mm >= 0) ||
      plan.cutter.corner_radius_mm > 0.5 * plan.cutter.diameter_mm) {
    refuse("the cutter's corner radius must be 0 mm to half its diameter");
  }
  if (plan.lines == 1 || plan.lines < 0) refuse("a path needs two lines or more");
  if (plan.points_per_line == 1 || plan.points_per_line < 0) {
    refuse("a line needs two points or more");
  }
  if (plan.lines == 0 && !(plan.scallop_mm > 0)) refuse("the scallop must be above 0 mm");
  if (plan.points_per_line == 0 && !(plan.chord_tolerance_mm > 0)) {
    refuse("the chord tolerance must be above 0 mm");
  }
  if (!(std::abs(plan.lead_rad) < 1.5) || !(std::abs(plan.tilt_rad) < 1.5)) {
    refuse("lead and tilt must be less than 85 degrees");
  }
}

/// One forward line of the path at a fixed u.
class Line {
 public:
  Line(const NurbsSurface& patch, const PathPlan& plan, double u, int number, bool is_forward)
      : patch_(patch), plan_(plan), u_(u), number_(number), is_forward_(is_forward) {}

  [[nodiscard]] SurfacePoint at(double v) const {
    const SurfaceShape shape = patch_.shape(u_, v);
    const Vector3 along = patch_.jet(u_, v).v;
    const Vector3 axis =
        lean(shape.normal, is_forward_ ? along : Vector3(-along), plan_.lead_rad, plan_.tilt_rad);
    return {u_,
            v,
            shape.point,
            shape.normal,
            tip_of_contact(plan_.cutter, shape.point, shape.normal, axis),
            axis,
            number_};
  }

  /// How far the tip curve between `a` and `b` leaves their chord.
  [[nodiscard]] double chord_error(const SurfacePoint& a, const SurfacePoint& b) const {
    const Vector3 chord = b.tip - a.tip;
    const double square = std::max(chord.squaredNorm(), 1e-300);
    double worst = 0;
    for (const double share : kChordShares) {
      const Vector3 off = at(a.v + share * (b.v - a.v)).tip - a.tip;
      worst = std::max(worst, (off - off.dot(chord) / square * chord).norm());
    }
    return worst;
  }

  /// Parameters of the line's points, rising.
  [[nodiscard]] std::vector<double> parameters() const {
    const double first = patch_.first_v(), last = patch_.last_v();
    std::vector<double> v;
    if (plan_.points_per_line > 0) {
      for (int i = 0; i < plan_.points_per_line; ++i) {
        v.push_back(first + (last - first) * i / (plan_.points_per_line - 1));
      }
      return v;
    }
    v.push_back(first);
    double step = (last - first) / 20;
    while (v.back() < last) {
      step = longest_step(v.back(), std::min(2.0 * step, last - v.back()));
      v.push_back(v.back() + step >= last - 1e-9 * (last - first) ? last : v.back() + step);
      if (v.size() > kMostPerLine) throw std::invalid_argument("the chord tolerance is too small");
    }
    return v;
  }

 private:
  [[nodiscard]] double longest_step(double from, double step) const {
    const SurfacePoint start = at(from);
    for (int halvings = 0; halvings < 60; ++halvings) {
      if (chord_error(start, at(from + step)) <= plan_.chord_tolerance_mm) break;
      step *= 0.7;
    }
    return step;
  }

  const NurbsSurface& patch_;
  const PathPlan& plan_;
  double u_;
  int number_;
  bool is_forward_;
};

/// Curvature of the surface across the direction `across` in the tangent plane (Euler's theorem).
double normal_curvature(const SurfaceJet& s, const Vector3& normal, const Vector3& across) {
  // the tangent-plane coordinates (a, b) of `across` in the basis Su, Sv
  const double e = s.u.dot(s.u), f = s.u.dot(s.v), g = s.v.dot(s.v), det = e * g - f * f;
  const double p = across.dot(s.u), q = across.dot(s.v);
  const double a = (g * p - f * q) / det, b = (e * q - f * p) / det;
  return a * a * s.uu.dot(normal) + 2.0 * a * b * s.uv.dot(normal) + b * b * s.vv.dot(normal);
}

/// What a step from line to line means at one point: the way across the line per u, and the squared
/// step width per scallop height, w² = 8 h / (1/R - k), with k concave positive.
struct Across {
  double mm_per_u, square_per_scallop;
};

Across across(const NurbsSurface& patch, const PathPlan& plan, const SurfacePoint& point) {
  const SurfaceJet s = patch.jet(point.u, point.v);
  const Vector3 side = point.normal.cross(s.v).normalized();
  const double cutter = gouge_curvature(plan.cutter, point.normal, point.axis);
  const double gap = cutter - normal_curvature(s, point.normal, side);
  return {std::abs(s.u.dot(side)), gap > 0 ? 8.0 / gap : 0.0};
}

/// The largest step in u from `line` that keeps the scallop, and never more than half the cutter.
double step_over(const NurbsSurface& patch, const PathPlan& plan, const Line& line) {
  double step = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kLineSamples; ++i) {
    const double v = patch.first_v() + (patch.last_v() - patch.first_v()) * i / (kLineSamples - 1);
    const SurfacePoint point = line.at(v);
    const Across way = across(patch, plan, point);
    const double scallop = way.square_per_scallop > 0
                               ? std::sqrt(plan.scallop_mm * way.square_per_scallop)
                               : plan.cutter.diameter_mm;
    const double width = std::min(scallop, 0.5 * plan.cutter.diameter_mm);
    step = std::min(step, width / std::max(way.mm_per_u, 1e-9));
  }
  return step;
}

std::vector<double> line_parameters(const NurbsSurface& patch, const PathPlan& plan) {
  const double first = patch.first_u(), last = patch.last_u();
  std::vector<double> u;
  if (plan.lines > 0) {
    for (int i = 0; i < plan.lines; ++i) u.push_back(first + (last - first) * i / (plan.lines - 1));
    return u;
  }
  u.push_back(first);
  while (u.back() < last) {
    const double here = step_over(patch, plan, Line(patch, plan, u.back(), 0, true));
    const double next = std::min(u.back() + here, last);
    // the next line may be steeper: the step must keep the scallop seen from there, too
    const double there = step_over(patch, plan, Line(patch, plan, next, 0, true));
    u.push_back(std::min(u.back() + std::min(here, there), last));
    if (u.size() > kMostLines) throw std::invalid_argument("the scallop is too small");
  }
  return u;
}

void judge_point(const PathPlan& plan, const SurfaceShape& shape, const SurfacePoint& point,
                 SurfacePath& path) {
  if (shape.largest_curvature <= 0) return;
  const double radius = 1.0 / shape.largest_curvature;
  if (path.least_concave_radius_mm == 0 || radius < path.least_concave_radius_mm) {
    path.least_concave_radius_mm = radius;
  }
  const double cutter = gouge_curvature(plan.cutter, point.normal, point.axis);
  if (shape.largest_curvature > cutter) {
    path.gouges.push_back({point.u, point.v, radius,
                           cutter > 0 ? 1.0 / cutter : std::numeric_limits<double>::infinity()});
  }
}

void judge_step(const NurbsSurface& patch, const PathPlan& plan, const SurfacePoint& point,
                double step_u, SurfacePath& path) {
  const Across way = across(patch, plan, point);
  if (!(way.square_per_scallop > 0)) return;
  const double width = way.mm_per_u * step_u;
  path.largest_scallop_mm =
      std::max(path.largest_scallop_mm, width * width / way.square_per_scallop);
}

}  // namespace

SurfacePath walk(const NurbsSurface& patch, const PathPlan& plan) {
  check(plan);
  SurfacePath path;
  const std::vector<double> lines = line_parameters(patch, plan);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_forward = i % 2 == 0;
    const Line line(patch, plan, lines[i], static_cast<int>(i), is_forward);
    std::vector<double> stations = line.parameters();
    if (!is_forward) std::reverse(stations.begin(), stations.end());
    for (std::size_t k = 0; k < stations.size(); ++k) {
      const SurfacePoint point = line.at(stations[k]);
      judge_point(plan, patch.shape(point.u, point.v), point, path);
      if (i + 1 < lines.size()) judge_step(patch, plan, point, lines[i + 1] - lines[i], path);
      if (k > 0) {
        path.largest_chord_error_mm =
            std::max(path.largest_chord_error_mm, line.chord_error(path.points.back(), point));
      }
      if (!path.points.empty()) path.length_mm += (point.tip - path.points.back().tip).norm();
      path.points.push_back(point);
    }
  }
  path.lines = static_cast<int>(lines.size());
  return path;
}

}  // namespace meridian::surface
