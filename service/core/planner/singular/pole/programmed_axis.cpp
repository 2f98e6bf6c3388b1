// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/programmed_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/geometry/great_circle.hpp"

namespace meridian {
namespace {

/// rad/mm. Gentler ones the band rounds by less than a hundredth of any tolerance.
constexpr double kMinKink_per_mm = 1e-6;

}  // namespace

void ProgrammedAxis::begin(const Vector3& axis) noexcept {
  first_ = 0;
  last_ = 1;
  marks_[0] = {0, to_array(axis), 0};
}

void ProgrammedAxis::add(double u, const Vector3& axis) noexcept {
  Mark& newest = marks_[static_cast<std::size_t>((last_ - 1) % kCapacity)];
  if (last_ - first_ >= 2) {
    const Mark& before = mark(last_ - 2);
    if (u - before.u < kMinGap_mm) {  // the newest moves on, what it was is hidden
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

std::int64_t ProgrammedAxis::mark_before(double u) const noexcept {
  std::int64_t low = first_, high = last_ - 1;
  while (high - low > 1) {
    const std::int64_t middle = (low + high) / 2;
    (mark(middle).u <= u ? low : high) = middle;
  }
  return low;
}

std::optional<ProgrammedAxis::Known> ProgrammedAxis::at(double u) const noexcept {
  if (last_ - first_ < 2 || u < mark(first_).u - 1e-9 || u > mark(last_ - 1).u + 1e-9) return {};
  const std::int64_t before = mark_before(u);
  const Mark &a = mark(before), &b = mark(before + 1);
  const Vector3 from = to_vector(a.axis), to = to_vector(b.axis);
  const double share = b.u > a.u ? std::clamp((u - a.u) / (b.u - a.u), 0.0, 1.0) : 0.0;
  const GreatCircle circle = find_great_circle(from, to);
  return Known{axis_on_circle(circle.begin, circle.normal, share * circle.turn), b.hidden_rad};
}

double ProgrammedAxis::angle_to(double u, const Vector3& axis) const noexcept {
  const auto there = at(u);
  if (!there) return std::numeric_limits<double>::infinity();
  return angle_between(there->axis, axis) + there->hidden_rad;
}

double ProgrammedAxis::next_end(double u) const noexcept {
  const std::int64_t next = mark_before(u) + (mark(first_).u > u ? 0 : 1);
  return next < last_ && mark(next).u > u ? mark(next).u : std::numeric_limits<double>::infinity();
}

double ProgrammedAxis::kink_at(std::int64_t n) const noexcept {
  const Mark &before = mark(n - 1), &here = mark(n), &after = mark(n + 1);
  const Vector3 axis = to_vector(here.axis);
  const Vector3 in = (axis - to_vector(before.axis)) / (here.u - before.u);
  const Vector3 out = (to_vector(after.axis) - axis) / (after.u - here.u);
  return (out - in).norm();
}

std::size_t ProgrammedAxis::find_kinks(double begin, double end,
                                       std::span<double> kinks) const noexcept {
  std::size_t found = 0;
  for (std::int64_t n = mark_before(begin) + 1; n + 1 < last_ && mark(n).u < end; ++n) {
    if (!(kink_at(n) > kMinKink_per_mm)) continue;
    if (found == kinks.size()) return find_sharpest(begin, end, kinks);
    kinks[found++] = mark(n).u;
  }
  return found;
}

std::size_t ProgrammedAxis::find_sharpest(double begin, double end,
                                          std::span<double> kinks) const noexcept {
  const double parts = static_cast<double>(kinks.size()) / (end - begin);
  const double last_part = static_cast<double>(kinks.size()) - 1;  // rounding may find one more
  std::size_t count = 0;
  double part = -1, sharpest = kMinKink_per_mm;
  for (std::int64_t n = mark_before(begin) + 1; n + 1 < last_ && mark(n).u < end; ++n) {
    const double u = mark(n).u, kink = kink_at(n);
    const double here = std::min(std::floor((u - begin) * parts), last_part);
    if (here > part) sharpest = kMinKink_per_mm;
    if (!(kink > sharpest)) continue;
    if (here > part) ++count;
    part = here;
    sharpest = kink;
    kinks[count - 1] = u;
  }
  return count;
}

}  // namespace meridian
