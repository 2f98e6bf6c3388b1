// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/bench/bench_paths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "meridian/geometry/vector3.hpp"
#include "meridian/units.hpp"
#include "service/programs/cl/cl_writer.hpp"

namespace meridian::bench {
namespace {

constexpr double kPi = std::numbers::pi;
using units::rad_from_deg;

struct Point {
  Vector3 tip, axis;
};
using Points = std::vector<Point>;

/// Leaning by `tilt` towards `azimuth`.
Vector3 leaning(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

/// The `n`th of `count` even steps from `from` to `to`.
double step(double from, double to, int n, int count) {
  return from + n * ((to - from) / (count - 1));
}

Points fan() {
  constexpr int kPoints = 21;
  Points points;
  for (int n = 0; n < kPoints; ++n) {
    const double s = step(0, 1, n, kPoints), tilt = rad_from_deg(-30 + 60 * s);
    points.push_back({{-50 + 100 * s, 20, 30}, {std::sin(tilt), 0, std::cos(tilt)}});
  }
  return points;
}

Points near_pole(int count, double x_mm) {
  constexpr double kFarthest_deg = 15, kNearest_deg = 0.1, kSharpness = 150;
  const double along_deg = std::sqrt(kFarthest_deg * kFarthest_deg - kNearest_deg * kNearest_deg);
  Points points;
  for (int n = 0; n < count; ++n) {
    const double s = step(-1, 1, n, count);
    const double tilt = rad_from_deg(std::hypot(kNearest_deg, along_deg * s));
    const double azimuth =
        rad_from_deg(90 - 85 * std::atan(kSharpness * s) / std::atan(kSharpness));
    points.push_back({{x_mm + 30 * s, 20, 30}, leaning(tilt, azimuth)});
  }
  return points;
}

/// Archimedes' spiral on a sphere: turns and chords are evenly spaced along the surface.
Points dome() {
  constexpr double kRadius_mm = 60, kChord_mm = 0.3;
  constexpr int kPoints = 5001, kNodes = 400001;
  const double first = rad_from_deg(1.0), last = rad_from_deg(45.0);
  const double area = 2 * kPi * kRadius_mm * kRadius_mm * (std::cos(first) - std::cos(last));
  const double turns_per_rad = 2 * kPi * kRadius_mm * kChord_mm * (kPoints - 1) / area;
  const auto speed = [&](double tilt) {
    const double across = turns_per_rad * std::sin(tilt);
    return kRadius_mm * std::sqrt(1 + across * across);
  };
  std::vector<double> length(kNodes, 0.0);
  for (int n = 1; n < kNodes; ++n) {
    const double a = step(first, last, n - 1, kNodes), b = step(first, last, n, kNodes);
    length[n] = length[n - 1] + 0.5 * (speed(a) + speed(b)) * (b - a);
  }
  Points points;
  for (int n = 0, node = 1; n < kPoints; ++n) {
    const double at = step(0, length.back(), n, kPoints);
    while (node + 1 < kNodes && length[node] < at) ++node;
    const double share = (at - length[node - 1]) / (length[node] - length[node - 1]);
    const double a = step(first, last, node - 1, kNodes), b = step(first, last, node, kNodes);
    const double tilt = a + share * (b - a);
    const Vector3 normal = leaning(tilt, turns_per_rad * (tilt - first));
    points.push_back({kRadius_mm * normal - Vector3(0, 0, 20), normal});
  }
  return points;
}

Points blade() {
  constexpr int kPasses = 10, kPoints = 151;
  Points points;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (int n = 0; n < kPoints; ++n) {
      const double s = step(0, 1, pass % 2 == 1 ? kPoints - 1 - n : n, kPoints);
      const double tilt = rad_from_deg(40 * std::sin(1.5 * kPi * s + 0.15 * pass));
      points.push_back({{-40 + 80 * s, 15 * std::sin(kPi * s) + 0.8 * pass,
                         20 + 2.0 * pass + 6 * std::sin(2 * kPi * s)},
                        leaning(tilt, rad_from_deg(60 + 60 * s))});
    }
  }
  return points;
}

struct Named {
  const char* name;
  Points (*make)();
};
constexpr Named kPaths[] = {{"fan", fan},
                            {"near_pole", [] { return near_pole(61, 0); }},
                            {"near_pole_coarse", [] { return near_pole(7, 0); }},
                            {"near_pole_rim", [] { return near_pole(61, 350); }},
                            {"dome", dome},
                            {"blade", blade}};

}  // namespace

std::vector<std::string> path_names() {
  std::vector<std::string> names;
  for (const Named& one : kPaths) names.emplace_back(one.name);
  return names;
}

std::vector<ClBlock> path(std::string_view name, double feed_mm_per_s) {
  std::vector<ClBlock> blocks;
  const auto* const named = std::find_if(std::begin(kPaths), std::end(kPaths),
                                         [&](const Named& one) { return one.name == name; });
  if (named == std::end(kPaths)) return blocks;
  for (const Point& point : named->make()) {
    ClBlock block;
    block.sequence = blocks.size();
    block.feed_meaning = FeedMeaning::kTip;
    block.feed = feed_mm_per_s;
    block.tip_mm = to_array(point.tip);
    block.axis = to_array(point.axis);
    blocks.push_back(block);
  }
  return blocks;
}

std::string path_file(std::string_view name, double feed_mm_per_s) {
  std::ostringstream out;
  cl::ClWriter writer(out, name);
  writer.note("Made by: meridian bench --write");
  for (const ClBlock& block : path(name, feed_mm_per_s)) writer.write(block);
  ClBlock end;
  end.kind = BlockKind::kEnd;
  writer.write(end);
  return out.str();
}

}  // namespace meridian::bench
