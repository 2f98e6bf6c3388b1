// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/analysis/certify/piece_check.hpp"

namespace meridian::certify {

/// What a jump of position, velocity or acceleration where two pieces meet adds to differences of
/// setpoints, as a share of the limit, for every order 1 to 3 of the difference.
using JumpShares = std::array<std::array<double, 3>, kMaxLimited>;

/// Proves that the pieces of a plan join: a difference of setpoints of order n is the mean of the
/// n-th derivative under a B-spline over n cycles, so that jumps Δq, Δq̇, Δq̈ inside of them add at
/// most
///
///     Δq/T     to the first,     Δq/T² + Δq̇/T     to the second,
///     2 Δq/T³ + Δq̇/T² + 3/4 Δq̈/T     to the third difference over Tⁿ
///
/// and those of every join within n cycles are added up. Source: docs/motion.md, section 12.
/// Proof: tests/unit/certify/join_check_test.cpp.
class JoinCheck {
 public:
  /// Jumps up to that share of a limit are taken for rounding, which limits are checked to; above
  /// it they have to have room beside the pieces that meet.
  static constexpr double kRoundingShare = 1e-6;

  explicit JoinCheck(const MachineModel& model)
      : model_(&model), period_s_(1e-9 * static_cast<double>(model.cycle_ns)) {}

  struct Verdict {
    bool is_joined = true;
    std::array<Share, 3> worst;  ///< by order, jumps within the cycles of a difference added up
    Share broken;                ///< where not joined
  };

  /// Nothing is known of what comes before.
  void forget() { *this = JoinCheck(*model_); }
  /// A piece follows. `is_same_path`: on the path of the one before, where windings of the joints
  /// mean nothing.
  [[nodiscard]] Verdict go_on(const PieceVerdict& piece, double duration, bool is_same_path);
  /// The plan rests here.
  [[nodiscard]] Verdict rest();

 private:
  struct Jump {
    double time_s;
    JumpShares shares;
  };

  [[nodiscard]] JumpShares jump_to(const EnclosedMotion& next, bool is_same_path) const;
  [[nodiscard]] Verdict check(const JumpShares& jump,
                              const std::array<std::array<double, 3>, kMaxLimited>& next_bound);

  const MachineModel* model_;
  double period_s_;
  bool is_known_ = false;
  double time_s_ = 0;
  EnclosedMotion end_;
  std::array<std::array<double, 3>, kMaxLimited> bound_{};
  std::vector<Jump> recent_;
};

}  // namespace meridian::certify
