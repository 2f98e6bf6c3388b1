// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/check/check_report.hpp"
#include "service/recording/record/file/recorded/recorded_limits.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::record {

/// Checks joints and the drives of a stage alone: travel, velocity, acceleration and jerk by finite
/// differences, the sent velocity, and that the drives fit the joints. Units: mm, rad, s.
class JointCheck {
 public:
  /// `largest`: the largest |position| of each joint and drive in the recording, for its rounding.
  /// `soft_limits`, in the order of their cycles, outlive it.
  JointCheck(const MachineModel& model, const LimitedVector& largest,
             std::span<const LimitsFrom> soft_limits);

  void add(const RecordingRow& row, bool has_velocity);
  /// Adds what was found to the report.
  void finish(CheckReport& report) const;

 private:
  void check_rates(int joint);
  void check_velocity(int joint);
  void check_travel(int joint);
  void check_keep_out(const KeepOut& keep_out);
  void check_stage(const RecordingRow& row);
  void note(Excess& excess, double use, bool is_over) const;

  static constexpr int kDepth = 4;  ///< rows of a third difference
  const MachineModel& model_;
  std::span<const LimitsFrom> soft_limits_;  ///< the first of them is in force, or the next
  double period_;
  LimitedVector ulp_{};
  std::array<RecordingRow, kDepth> rows_{};  ///< newest last
  int run_ = 0;                              ///< consecutive enabled cycles at the end of rows_
  bool has_row_ = false, has_led_ = false, is_homing_ = false;
  std::array<JointUse, kMaxLimited> use_{};
  std::array<std::array<Excess, 3>, kMaxLimited> over_{};
  std::array<Excess, kMaxLimited> outside_{};
  std::array<Excess, kMaxLimited> sent_{};
  Excess in_box_;
  StageUse stage_use_;
  Excess unfit_;
  Peak sent_peak_;
  std::uint64_t fault_rows_ = 0, dry_rows_ = 0;
};

}  // namespace meridian::record
