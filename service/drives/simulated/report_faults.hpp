// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "meridian/kinematics/joints.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::drives {

/// What is wrong with the reports of drives that are well themselves.
/// Proof: tests/unit/simulated_drives/drive_group_test.cpp.
class ReportFaults {
 public:
  /// The report of drive `i` stays at what it is now, `position`.
  void freeze(std::size_t i, double position) noexcept {
    frozen_mask_ |= 1U << i;
    frozen_[i] = position;
  }
  void make_no_number(std::size_t i) noexcept { no_number_mask_ |= 1U << i; }
  void mute(std::size_t i) noexcept { mute_mask_ |= 1U << i; }
  void lose_reference(std::size_t i) noexcept { unreferenced_mask_ |= 1U << i; }
  /// Reports do not tell the setpoint that was taken last.
  void leave_out_cycle() noexcept { is_cycle_left_out_ = true; }
  /// In the next report only.
  void add_once(std::size_t i, double by) noexcept { spike_[i] += by; }

  /// Every report is off by `by` more than the one before.
  void creep(std::size_t i, double by) noexcept { creep_[i] = by; }

  void apply(dds::DriveFeedback& feedback) noexcept {
    for (std::size_t i = 0; i < kMaxJoints; ++i) {
      const std::uint32_t bit = 1U << i;
      if ((frozen_mask_ & bit) != 0) feedback.position[i] = frozen_[i];
      if ((no_number_mask_ & bit) != 0) {
        feedback.position[i] = std::numeric_limits<double>::quiet_NaN();
      }
      crept_[i] += creep_[i];
      feedback.position[i] += spike_[i] + crept_[i];
    }
    spike_ = {};
    feedback.joint_mask &= ~mute_mask_;
    feedback.referenced_mask &= ~unreferenced_mask_;
    if (is_cycle_left_out_) feedback.cycle_seen = 0;
  }

 private:
  std::uint32_t frozen_mask_ = 0, no_number_mask_ = 0, mute_mask_ = 0, unreferenced_mask_ = 0;
  bool is_cycle_left_out_ = false;
  JointVector frozen_{}, spike_{}, creep_{}, crept_{};
};

}  // namespace meridian::drives
