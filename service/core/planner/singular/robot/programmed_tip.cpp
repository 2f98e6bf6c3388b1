// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/programmed_tip.hpp"

#include <algorithm>
#include <limits>

namespace meridian {
namespace {

constexpr double kSamePosition_mm = 1e-9;  // of u

}  // namespace

void ProgrammedTip::begin(const Vector3& tip) noexcept {
  first_ = 0;
  last_ = 1;
  marks_[0] = {0, to_array(tip)};
}

void ProgrammedTip::add(double u, const Vector3& tip) noexcept {
  if (last_ - first_ == kCapacity) ++first_;
  marks_[static_cast<std::size_t>(last_++ % kCapacity)] = {u, to_array(tip)};
}

double ProgrammedTip::distance_to(double u, const Vector3& tip) const noexcept {
  const bool is_known = last_ - first_ >= 2 && u >= mark(first_).u - kSamePosition_mm &&
                        u <= mark(last_ - 1).u + kSamePosition_mm;
  if (!is_known) return std::numeric_limits<double>::infinity();
  std::int64_t low = first_, high = last_ - 1;
  while (high - low > 1) {
    const std::int64_t middle = (low + high) / 2;
    (mark(middle).u <= u ? low : high) = middle;
  }
  const Mark &a = mark(low), &b = mark(high);
  const double share = b.u > a.u ? std::clamp((u - a.u) / (b.u - a.u), 0.0, 1.0) : 0.0;
  return (tip - (1 - share) * to_vector(a.tip) - share * to_vector(b.tip)).norm();
}

}  // namespace meridian
