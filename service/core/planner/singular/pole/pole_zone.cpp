// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_zone.hpp"

namespace meridian {

FreeQuintic part_of(const FreeQuintic& whole, double from, double to) noexcept {
  const auto split = [](const FreeQuintic& values, double t, bool is_left) {
    FreeQuintic level = values, left{}, right{};
    for (std::size_t n = 0; n < 6; ++n) {
      left[n] = level[0];
      right[5 - n] = level[5 - n];
      for (std::size_t k = 0; k + n < 5; ++k) level[k] += (level[k + 1] - level[k]) * t;
    }
    return is_left ? left : right;
  };
  const FreeQuintic left = to < 1 ? split(whole, to, true) : whole;
  return from > 0 ? split(left, from / to, false) : left;
}

}  // namespace meridian
