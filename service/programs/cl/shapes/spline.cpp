// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/spline.hpp"

#include <algorithm>
#include <cmath>

namespace meridian::cl {
namespace {

constexpr std::size_t kDegree = 3;

/// The whole knot vector: four at each end.
std::vector<double> knots_of(const ClampedCubic& spline) {
  std::vector<double> knots(kDegree + 1, 0.0);
  knots.insert(knots.end(), spline.inner_knots.begin(), spline.inner_knots.end());
  knots.insert(knots.end(), kDegree + 1, 1.0);
  return knots;
}

/// de Boor's recursion in span `span`: knots[span] <= u <= knots[span + 1].
ToolPose evaluate(const ClampedCubic& spline, const std::vector<double>& knots, std::size_t span,
                  double u) {
  std::array<ToolPose, kDegree + 1> d;
  for (std::size_t i = 0; i <= kDegree; ++i) d[i] = spline.points[span - kDegree + i];
  for (std::size_t level = 1; level <= kDegree; ++level) {
    for (std::size_t i = kDegree; i >= level; --i) {
      const double low = knots[span - kDegree + i], high = knots[span + i + 1 - level];
      const double part = (u - low) / (high - low);
      d[i].tip = (1 - part) * d[i - 1].tip + part * d[i].tip;
      d[i].axis = (1 - part) * d[i - 1].axis + part * d[i].axis;
    }
  }
  return d[kDegree];
}

/// Control points of the second derivative, one after the other; 0 where knots coincide.
std::vector<ToolPose> second_derivative(const ClampedCubic& spline,
                                        const std::vector<double>& knots) {
  std::vector<ToolPose> d = spline.points;
  for (std::size_t level = 0; level < 2; ++level) {
    const double degree = static_cast<double>(kDegree - level);
    for (std::size_t i = 0; i + 1 < d.size(); ++i) {
      const double width = knots[i + kDegree + 1] - knots[i + level + 1];
      const double factor = width > 0 ? degree / width : 0;
      d[i] = {factor * (d[i + 1].tip - d[i].tip), factor * (d[i + 1].axis - d[i].axis)};
    }
    d.pop_back();
  }
  return d;
}

double chords_needed(double second, double width, double tolerance) {
  return std::ceil(width * std::sqrt(second / (8 * tolerance)));
}

}  // namespace

ToolPose ClampedCubic::at(double u) const {
  const std::vector<double> knots = knots_of(*this);
  std::size_t span = kDegree;
  while (span + 1 < points.size() && u >= knots[span + 1]) ++span;
  return evaluate(*this, knots, span, u);
}

std::vector<ToolPose> chords_of(const ClampedCubic& spline, const ChordTolerance& tolerance) {
  const std::vector<double> knots = knots_of(spline);
  const std::vector<ToolPose> second = second_derivative(spline, knots);
  std::vector<ToolPose> out;
  for (std::size_t span = kDegree; span < spline.points.size(); ++span) {
    const double low = knots[span], width = knots[span + 1] - low;
    if (!(width > 0)) continue;
    const ToolPose& a = second[span - kDegree];
    const ToolPose& b = second[span - kDegree + 1];
    const double count = std::max(
        {1.0, chords_needed(std::max(a.tip.norm(), b.tip.norm()), width, tolerance.tip_mm),
         chords_needed(std::max(a.axis.norm(), b.axis.norm()), width, tolerance.axis_rad)});
    if (!(static_cast<double>(out.size()) + count <= static_cast<double>(kMaxChords))) return {};
    for (double i = 1; i <= count; ++i) {
      ToolPose pose = evaluate(spline, knots, span, low + width * (i / count));
      pose.axis.normalize();
      out.push_back(pose);
    }
  }
  return out;
}

}  // namespace meridian::cl
