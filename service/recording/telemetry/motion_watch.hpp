// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/limited.hpp"

namespace meridian::telemetry {

/// Watches the records go by and says what the operator wants to see of the motion: how fast the
/// tip really moves and which joint is nearest to its limits. Checked over the records since the
/// last reset(). Units: mm, s. Proof: tests/unit/telemetry/motion_watch_test.cpp.
class MotionWatch {
 public:
  explicit MotionWatch(const MachineModel& model) noexcept : model_(model) {}

  void see(const CycleRecord& record, double tool_length_mm) noexcept;
  void reset() noexcept;

  /// Tip speed in the workpiece frame at the newest record, mm/s.
  [[nodiscard]] double feed_mm_per_s() const noexcept { return feed_mm_per_s_; }
  /// The joint, or drive of the stage, that used the largest share of its velocity, acceleration or
  /// jerk; -1 where no joint came beyond kLimiting of any.
  [[nodiscard]] int limiting_joint() const noexcept {
    return largest_share_ >= kLimiting ? joint_ : -1;
  }
  [[nodiscard]] double largest_share() const noexcept { return largest_share_; }

  static constexpr double kLimiting = 0.5;

 private:
  void check(const LimitedVector& velocities, double period_s) noexcept;

  const MachineModel& model_;
  LimitedVector velocity_{};  ///< of the newest record
  LimitedVector acceleration_{};
  std::uint64_t last_cycle_ = 0;
  int consecutive_ = 0;
  double feed_mm_per_s_ = 0;
  double largest_share_ = 0;
  int joint_ = -1;
};

}  // namespace meridian::telemetry
