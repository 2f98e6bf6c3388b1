// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/band_span.hpp"

/// Paths whose axis leans as a test says, for what looks at spans beside the pole.
namespace meridian::test {

/// The axis seen along the pole: it is (x, y, 1), made unit.
struct Lean {
  double x = 0, y = 0;
};

/// One span of 1 mm of u from `begin` to `end`; the tip goes along x, 0.8 mm.
inline BandSpan leaning_span(int number, const Lean& begin, const Lean& end) {
  BandSpan span;
  span.u0 = number;
  span.length = 1;
  span.sequence = static_cast<std::uint64_t>(number);
  span.line = static_cast<std::uint32_t>(number) + 100;
  span.feed_mm_per_s = 50;
  span.c[0] = {0.8 * number, 0.8};
  span.c[1] = {10};
  span.c[2] = {-20};
  span.c[3] = {begin.x, end.x - begin.x};
  span.c[4] = {begin.y, end.y - begin.y};
  span.c[5] = {1};
  return span;
}

/// `count` spans whose axis leans as lean(u) at their ends.
template <class LeanAt>
std::vector<BandSpan> leaning_path(int count, const LeanAt& lean) {
  std::vector<BandSpan> out;
  for (int n = 0; n < count; ++n) out.push_back(leaning_span(n, lean(n), lean(n + 1)));
  return out;
}

inline Vector3 axis_of(const Lean& lean) { return Vector3(lean.x, lean.y, 1).normalized(); }

}  // namespace meridian::test
