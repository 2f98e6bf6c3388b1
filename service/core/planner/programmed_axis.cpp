// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/programmed_axis.hpp"

#include <algorithm>
#include <limits>

#include "meridian/geometry/great_circle.hpp"

namespace meridian {

void ProgrammedAxis::begin(const Vector3& axis) noexcept {
  first_ = 0;
  last_ = 1;
  marks_[0] = {0, to_array(axis), 0};
}

void ProgrammedAxis::add(double u, const Vector3& axis) noexcept {
  Mark& newest = marks_[static_cast<std::size_t>((last_ - 1) % kCapacity)];
  if (last_ - first_ >= 2) {
    const Mark& before = mark(last_ - 2);
    if (u - before.u < kLeastGap_mm) {  // the newest moves on, what it was is hidden
      const Vector3 from = to_vector(before.axis);
      const double off =
          std::max(angle_between(from, to_vector(newest.axis)), angle_between(from, axis));
      newest = {u, to_array(axis), std::max(newest.hidden_rad, 2 * off)};
      return;
    }
  }
  if (last_ - first_ == kCapacity) ++first_;
  marks_[static_cast<std::size_t>(last_++ % kCapacity)] = {u, to_array(axis), 0};
}

double ProgrammedAxis::angle_to(double u, const Vector3& axis) const noexcept {
  std::int64_t low = first_, high = last_ - 1;
  if (high <= low || u < mark(low).u - 1e-9 || u > mark(high).u + 1e-9) {
    return std::numeric_limits<double>::infinity();
  }
  while (high - low > 1) {
    const std::int64_t middle = (low + high) / 2;
    (mark(middle).u <= u ? low : high) = middle;
  }
  const Mark &a = mark(low), &b = mark(high);
  const Vector3 from = to_vector(a.axis), to = to_vector(b.axis);
  const double share = b.u > a.u ? std::clamp((u - a.u) / (b.u - a.u), 0.0, 1.0) : 0.0;
  const GreatCircle way = find_great_circle(from, to);
  return angle_between(axis_on_circle(way.begin, way.normal, share * way.turn), axis) +
         b.hidden_rad;
}

}  // namespace meridian
