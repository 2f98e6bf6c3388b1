// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace meridian {

namespace detail {

/// angle = hi + (sign · a + lo), with a the angle that is left in an eighth of a turn.
struct Octant {
  double hi, lo, sign;
};

// By (is_wide, is_steep, is_left): multiples of π/4 in two parts.
inline constexpr std::array<Octant, 8> kOctants{
    {{0.0, 0.0, 1.0},
     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55, 1.0},
     {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -1.0},
     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55, -1.0},
     {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53, -1.0},
     {0x1.2d97c7f3321d2p+1, 0x1.a79394c9e8a0ap-54, -1.0},
     {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, 1.0},
     {0x1.2d97c7f3321d2p+1, 0x1.a79394c9e8a0ap-54, 1.0}}};

}  // namespace detail

/// The angle of the point (x, y), as std::atan2 to 2.5 units in the last place (1.4e-16 rad),
/// zeros, infinities and NaN included.
///
/// It stands beside the C library's because that one is chosen by the host's processor, so that its
/// bits differ from host to host, and costs three times as much. One division: the angle is brought
/// below π/8 and its arctangent is z + z³ P(z²), P the Chebyshev fit of degree 10 on [0,
/// tan²(π/8)], 6e-18 of the angle off. Always inlined: whether the cycle's
/// own calls are must not hang on who else calls it. RT: cycle. Proof:
/// tests/unit/geometry/atan2_test.cpp.
[[nodiscard, gnu::always_inline]] inline double atan2(double y, double x) noexcept {
  constexpr double kTanEighth = 0x1.a827999fcef32p-2;  // tan(π/8)
  constexpr double kMin = 1e-290, kMax = 1e290;        // beyond: the library's
  const double ax = std::abs(x), ay = std::abs(y);
  const bool is_steep = ay > ax;
  const double small = is_steep ? ax : ay, large = is_steep ? ay : ax;
  if (!(large > kMin && large < kMax && small < kMax)) return std::atan2(y, x);
  const bool is_wide = small > kTanEighth * large;
  const double n = is_wide ? small - large : small;
  const double d = is_wide ? small + large : large;
  const double z = n / d, u = z * z, u2 = u * u, u4 = u2 * u2;
  const double p0 = -0x1.5555555555555p-2 + u * 0x1.9999999999344p-3;
  const double p2 = -0x1.2492492435beep-3 + u * 0x1.c71c7185006ddp-4;
  const double p4 = -0x1.745d0b1ef71ecp-4 + u * 0x1.3b1262253e208p-4;
  const double p6 = -0x1.10fa6b502376ep-4 + u * 0x1.dfe57271156bbp-5;
  const double p8 = -0x1.a095374ce56bbp-5 + u * 0x1.41560ea6668bfp-5;
  const double low = (p0 + u2 * p2) + u4 * (p4 + u2 * p6);
  const double high = p8 - u2 * 0x1.3a129c8a05421p-6;
  const double a = z + z * u * (low + u4 * u4 * high);
  const detail::Octant& octant =
      detail::kOctants[(is_wide ? 1U : 0U) + (is_steep ? 2U : 0U) + (x < 0 ? 4U : 0U)];
  return std::copysign(octant.hi + (octant.sign * a + octant.lo), y);
}

}  // namespace meridian
