// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/kinematics/limited.hpp"

namespace meridian::scene {

/// Share of the limit of velocity, acceleration and jerk; 1 is the limit.
using Shares = Limited<std::array<double, 3>>;

/// Which limits hold.
enum class Bounds : std::uint8_t { kOfMotion, kOfFaultStop };

/// How near joints and drives come to their limits, by finite differences of one cycle after the
/// other. Where a cycle was lost, or the machine does not lead by the setpoint, the row of them
/// breaks, and what is not known counts as 0. Fixed memory. Units: mm, rad, s. Proof:
/// tests/unit/ros/derived_row_test.cpp, tests/panel/panel_unit_test.cpp.
class LimitShares {
 public:
  /// `model` must live on.
  explicit LimitShares(const MachineModel& model) : model_(model) {}

  /// The positions of the next cycle; `is_next`: the machine led them there from the last ones.
  void add(const LimitedVector& positions, bool is_next, Bounds bounds) noexcept;

  /// The largest since clear().
  [[nodiscard]] const Shares& largest() const noexcept { return largest_; }
  void clear() noexcept { largest_ = {}; }

 private:
  const MachineModel& model_;
  int known_ = 0;                          ///< differences that there are of the cycle before
  std::array<LimitedVector, 3> before_{};  ///< position, velocity, acceleration
  Shares largest_{};
};

}  // namespace meridian::scene
