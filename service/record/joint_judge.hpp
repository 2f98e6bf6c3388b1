// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/record/check_report.hpp"
#include "service/record/recording_reader.hpp"

namespace meridian::record {

/// Judges joints alone: travel, velocity, acceleration and jerk by finite differences, and the sent
/// velocity. Units: mm, rad, s.
class JointJudge {
 public:
  /// `largest`: the largest |position| of each joint in the recording, for its rounding.
  JointJudge(const MachineModel& model, const JointVector& largest);

  void add(const RecordingRow& row, bool has_velocity);
  /// Adds what was found to the report.
  void finish(CheckReport& report) const;

 private:
  struct Excess {
    Peak use;  ///< worst value / limit
    std::uint64_t count = 0;
  };
  void judge_rates(int joint);
  void judge_velocity(int joint);
  void note(Excess& excess, double use, bool is_over) const;

  static constexpr int kDepth = 4;  ///< rows of a third difference
  const MachineModel& model_;
  double period_;
  JointVector ulp_{};
  std::array<RecordingRow, kDepth> rows_{};  ///< newest last
  int run_ = 0;                              ///< consecutive enabled cycles at the end of rows_
  bool has_row_ = false;
  std::array<JointUse, kMaxJoints> use_{};
  std::array<std::array<Excess, 3>, kMaxJoints> over_{};
  std::array<Excess, kMaxJoints> outside_{};
  std::array<Excess, kMaxJoints> sent_{};
  Peak sent_peak_;
  std::uint64_t fault_rows_ = 0;
};

}  // namespace meridian::record
