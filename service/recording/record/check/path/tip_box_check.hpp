// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/check_report.hpp"
#include "service/recording/record/check/line_tool.hpp"
#include "service/recording/record/check/path/checked_path.hpp"
#include "service/recording/record/file/recorded/recorded_limits.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::record {

/// Checks that the tip, of the tool that the path has there, stays in the tip box of the machine
/// and in that of the soft limits of each cycle, or goes no farther outside. Units: mm.
class TipBoxCheck {
 public:
  /// `path` and `soft_limits`, in the order of their cycles, outlive it.
  TipBoxCheck(const MachineModel& model, const CheckedPath& path,
              std::span<const LimitsFrom> soft_limits);

  /// Rows of the cut, and before it those of the approach to its begin.
  void add(const RecordingRow& row, bool is_cut);
  /// Adds what was found to the report.
  void finish(CheckReport& report) const;

 private:
  void check(const TipBox& box, const Array3& tip, const RecordingRow& row);

  const MachineModel& model_;
  const CheckedPath& path_;
  LineTool tool_;
  std::span<const LimitsFrom> soft_limits_;  ///< the first of them is in force, or the next
  bool has_boxes_;
  double tool_length_mm_;
  JointVector before_{};     ///< joints of the cycle before
  std::uint64_t cycle_ = 0;  ///< of that
  Excess outside_;
};

}  // namespace meridian::record
