// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/record/check.hpp"

namespace meridian::record {

/// Judges the rows of kind `unwind`, in which the tool is off its path on purpose: it leaves the
/// part along its axis, the free joint alone turns by whole turns when it is off by the whole
/// declared way, it comes back along the same line to where it left. Anything else is a finding,
/// also any such row on a machine whose file has no unwinding. Units: mm, rad. Frame: W.
class UnwindJudge {
 public:
  /// Both tolerances of `options` are in force. `tool_length_mm`: any; the tool moves along its
  /// axis, whatever its length.
  UnwindJudge(const MachineModel& model, double tool_length_mm, const CheckOptions& options);

  /// Takes every row of the cut, in order. Returns whether it is one of an unwinding.
  bool add(const RecordingRow& row);
  void finish(CheckReport& report);

 private:
  void begin(const RecordingRow& row);
  void judge(const RecordingRow& row);
  void end(const RecordingRow& row);
  void blame(const char* what, const RecordingRow& row);

  const MachineModel& model_;
  double tool_length_;
  CheckOptions options_;
  int free_;
  RecordingRow last_;
  bool has_last_ = false, is_in_ = false;
  bool has_rest_ = false;  ///< the row before the first one is there
  JointVector rest_{};     ///< where the tool left
  JointVector line_{};     ///< last place on the line that it left by
  ToolPose begin_{Vector3::Zero(), Vector3::UnitZ()};
  double off_ = 0;  ///< at line_
  std::uint64_t count_ = 0, bad_ = 0;
  const char* what_ = "";
  std::uint64_t bad_cycle_ = 0;
  std::uint32_t bad_line_ = 0;
};

}  // namespace meridian::record
