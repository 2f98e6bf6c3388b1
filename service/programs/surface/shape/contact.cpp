// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/geometry/segment.hpp"

namespace meridian::surface {
namespace {

constexpr int kChordSamples = 9;  // one of them in the middle, where a parabola has its sagitta
constexpr double kFlatRadius_mm =
    1e7;  // what stands for a straight cutter: 1 nm of sag over 0.2 mm

/// Radius of the circle that the cutter shows across the feed (eq. 3.2).
double radius_across(const ContactRule& rule, const Contact& c) noexcept {
  const Eigen::Matrix2d bend = curvature_of(rule.cutter, c.shape, c.pose.axis);
  const Vector3 across = c.shape.normal.cross(c.feed);
  const Eigen::Vector2d d{across.dot(c.shape.tangent_u), across.dot(c.shape.tangent_2)};
  const double curvature = d.dot(bend * d);
  return curvature * kFlatRadius_mm > 1 ? 1 / curvature : kFlatRadius_mm;
}

}  // namespace

std::optional<Contact> find_contact(const ContactRule& rule, double u, double v) noexcept {
  const auto shape = shape_at(*rule.surface, u, v, rule.is_flipped);
  if (!shape) return std::nullopt;
  Contact out{u, v, *shape, {}, {}};
  out.feed = rule.runs_along_u ? shape->tangent_u : shape->tangent_v;
  const Vector3 axis = leant_axis(shape->normal, out.feed, rule.lead_rad, rule.tilt_rad);
  out.pose = touching(rule.cutter, shape->at, shape->normal, axis);
  return out;
}

std::optional<double> chord_error(const ContactRule& rule, const Contact& from,
                                  const Contact& to) noexcept {
  double worst = 0;
  for (int i = 1; i <= kChordSamples; ++i) {
    const double share = static_cast<double>(i) / (kChordSamples + 1);
    const auto c =
        find_contact(rule, from.u + share * (to.u - from.u), from.v + share * (to.v - from.v));
    if (!c) return std::nullopt;
    worst = std::max({worst, distance_to_segment(c->shape.at, from.shape.at, to.shape.at),
                      distance_to_segment(c->pose.tip, from.pose.tip, to.pose.tip)});
  }
  return worst;
}

double scallop_between(const ContactRule& rule, const Contact& a, const Contact& b) noexcept {
  constexpr double kNoOverlap = std::numeric_limits<double>::infinity();
  if ((b.shape.at - a.shape.at).norm() >= rule.cutter.diameter_mm) return kNoOverlap;
  const double radius = std::min(radius_across(rule, a), radius_across(rule, b));
  const Vector3 centre_a = a.shape.at + radius * a.shape.normal;
  const Vector3 half = 0.5 * (b.shape.at + radius * b.shape.normal - centre_a);
  const double apart = half.norm();
  if (!(apart < radius)) return kNoOverlap;
  Vector3 outward = a.shape.normal + b.shape.normal;
  if (apart > 0) outward -= outward.dot(half) / (apart * apart) * half;
  const double length = outward.norm();
  if (!(length > 0)) return kNoOverlap;
  const double depth = std::sqrt((radius - apart) * (radius + apart));
  const Vector3 cusp = centre_a + half - depth / length * outward;
  return nearest_foot(*rule.surface, cusp, 0.5 * (a.u + b.u), 0.5 * (a.v + b.v)).distance_mm;
}

}  // namespace meridian::surface
