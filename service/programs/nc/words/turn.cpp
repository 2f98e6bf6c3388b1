// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/words/turn.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "service/programs/cl/cl_points.hpp"

namespace meridian::nc {
namespace {

constexpr double kLongestStep_deg = 30;  // so that no whole turn hides between two points
constexpr double kSameAxis_rad = 1e-9;

double before(const std::vector<RotaryAt>& from, const std::string& address) {
  for (const RotaryAt& at : from) {
    if (at.address == address) return at.deg.value_or(0);
  }
  return 0;
}

double angle(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

std::vector<RotaryAt> between(const std::vector<RotaryAt>& from, const std::vector<RotaryAt>& to,
                              double share) {
  std::vector<RotaryAt> out = to;
  for (RotaryAt& at : out) {
    if (!at.deg) continue;
    const double begin = before(from, at.address);
    at.deg = share < 1 ? begin + share * (*at.deg - begin) : *at.deg;
  }
  return out;
}

double largest_turn_deg(const std::vector<RotaryAt>& from, const std::vector<RotaryAt>& to) {
  double max = 0;
  for (const RotaryAt& at : to) {
    if (at.deg) max = std::max(max, std::abs(*at.deg - before(from, at.address)));
  }
  return max;
}

int pieces_of_turn(const MachineAxes& axes, const std::vector<RotaryAt>& from,
                   const std::vector<RotaryAt>& to, double tolerance_rad) {
  const auto axis_at = [&](double share) { return axes.axis(between(from, to, share)); };
  const Vector3 begin = axis_at(0);
  int pieces =
      std::max(1, static_cast<int>(std::ceil(largest_turn_deg(from, to) / kLongestStep_deg)));
  double turn = 0;
  for (int half = 1; half <= 2 * pieces; ++half) {
    turn = std::max(turn, angle(begin, axis_at(half / (2.0 * pieces))));
  }
  if (turn < kSameAxis_rad) return 1;
  const auto worst_of = [&](int count) {
    double worst = 0;
    Vector3 a = begin;
    for (int k = 0; k < count; ++k) {
      const Vector3 b = axis_at((k + 1.0) / count);
      worst = std::max(worst, angle(axis_at((k + 0.5) / count), cl::turn_towards(a, b, 0.5)));
      a = b;
    }
    return worst;
  };
  if (pieces > 1 && worst_of(1) <= tolerance_rad && largest_turn_deg(from, to) < 180) return 1;
  while (pieces < kMaxPieces && worst_of(pieces) > tolerance_rad) pieces *= 2;
  return pieces;
}

}  // namespace meridian::nc
