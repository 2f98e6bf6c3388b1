// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/soft_limits.hpp"
#include "service/text/checksum.hpp"

namespace meridian::stream {

/// By which station and service know that they mean the same soft limits: FNV-1a, 64 bit, of joint,
/// minimum and maximum of every pair, then of every joint of every keep-out box after the number of
/// the box, -1 of the first, then of the tip box the number -9 and minimum and maximum of X, Y, Z,
/// as doubles, as they lie in memory. Never 0.
/// Proof: tests/unit/protocol/limits_sum_test.cpp.
[[nodiscard]] inline std::uint64_t limits_sum(const SoftLimits& limits) noexcept {
  text::Checksum sum;
  for (std::size_t joint = 0; joint < limits.rows().size(); ++joint) {
    const SoftLimits::Row& row = limits.rows()[joint];
    if (!row.is_set) continue;
    sum.add(static_cast<double>(joint));
    sum.add(row.min);
    sum.add(row.max);
  }
  double number = 0;
  for (const KeepOutBox& box : limits.keep_out().boxes()) {
    sum.add(--number);
    for (int joint = 0; joint < kMaxJoints; ++joint) {
      if (!box.has(joint)) continue;
      sum.add(static_cast<double>(joint));
      sum.add(box.min[static_cast<std::size_t>(joint)]);
      sum.add(box.max[static_cast<std::size_t>(joint)]);
    }
  }
  constexpr double kTipNumber = -1 - KeepOut::kMax;
  const TipBox& tip = limits.tip_box();
  if (tip.is_set) sum.add(kTipNumber);
  for (std::size_t i = 0; tip.is_set && i < tip.min.size(); ++i) {
    sum.add(tip.min[i]);
    sum.add(tip.max[i]);
  }
  return sum.sum();
}

}  // namespace meridian::stream
