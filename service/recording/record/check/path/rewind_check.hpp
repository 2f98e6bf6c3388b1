// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/check/line_tool.hpp"

namespace meridian::record {

/// Checks the rows of kind `unwind`, in which the tool is off its path on purpose: it leaves the
/// part along its axis and comes back along the same line to where it left. When it is off by the
/// whole declared way the redundant joint alone turns by whole turns; or the axis goes to the pole
/// and back on another branch, with the tip at rest. Anything else is a finding, also any such row
/// on a machine whose file has no rewind.
///
/// The point where the tool rested is the row before. Where up to kMaxMissing rows are missing
/// there, it is known to the way that the tool made meanwhile: from rest it grows faster, so less
/// than the step seen next for every cycle; the same at the other end. Where more are missing the
/// line alone is checked. Units: mm, rad. Frame: W.
class RewindCheck {
 public:
  /// Both tolerances of `options` are in force.
  RewindCheck(const MachineModel& model, const CheckedPath& path, const CheckOptions& options);

  /// Takes every row of the cut, in order. Returns whether it is one of a rewind.
  bool add(const RecordingRow& row);
  void finish(CheckReport& report);

 private:
  static constexpr std::uint64_t kMaxMissing = 4;

  void begin(const RecordingRow& row);
  void check(const RecordingRow& row);
  void end(const RecordingRow& row);
  void check_turn(double off, const RecordingRow& row);
  void blame(const char* what, const RecordingRow& row);
  [[nodiscard]] ToolPose held_pose(const RecordingRow& row) const;
  [[nodiscard]] bool is_on_line(const ToolPose& pose) const;
  /// Whether the tip stands on the line and the axis is on its way through the pole.
  [[nodiscard]] bool is_tilted(const ToolPose& pose) const;

  const MachineModel& model_;
  LineTool tool_;
  double tool_length_ = 0;  ///< of the rewind
  CheckOptions options_;
  int free_;
  RecordingRow last_;
  bool has_last_ = false, is_in_ = false;
  bool has_rest_ = false;    ///< where the tool left is known, to `slack_`
  bool has_turned_ = false;  ///< the redundant joint turns or has turned
  bool has_tilted_ = false;  ///< the axis goes or went through the pole
  double held_ = 0;          ///< where the redundant joint stands on the line
  JointVector rest_{};       ///< where the tool left, or the first row
  ToolPose begin_{Vector3::Zero(), Vector3::UnitZ()};
  double missing_ = 0;                   ///< rows between rest and the first one
  double slack_ = 0;                     ///< of the point where the tool left, mm
  double off_ = 0, step_ = 0, top_ = 0;  ///< of the last row; per cycle; where the joint turns. mm
  std::uint64_t rows_ = 0;               ///< of this rewind
  std::uint64_t count_ = 0, bad_ = 0;
  const char* what_ = "";
  std::uint64_t bad_cycle_ = 0;
  std::uint32_t bad_line_ = 0;
};

}  // namespace meridian::record
