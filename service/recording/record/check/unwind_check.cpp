// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/unwind_check.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/winding.hpp"

namespace meridian::record {

UnwindCheck::UnwindCheck(const MachineModel& model, double tool_length_mm,
                         const CheckOptions& options)
    : model_(model),
      tool_length_(tool_length_mm),
      options_(options),
      free_(redundant_joint(model)) {}

void UnwindCheck::blame(const char* what, const RecordingRow& row) {
  if (bad_++ > 0) return;
  what_ = what;
  bad_cycle_ = row.cycle;
  bad_line_ = row.line;
}

/// With the redundant joint where it was: what its turns do to the tool is no matter of the line.
ToolPose UnwindCheck::held_pose(const RecordingRow& row) const {
  JointVector held = row.joints;
  held[free_] = rest_[free_];
  return forward(model_, tool_length_, held);
}

void UnwindCheck::begin(const RecordingRow& row) {
  ++count_;
  const std::uint64_t missing = has_last_ ? row.cycle - last_.cycle - 1 : kMaxMissing + 1;
  has_rest_ = missing <= kMaxMissing;
  rest_ = missing == 0 ? last_.joints : row.joints;
  begin_ = forward(model_, tool_length_, rest_);
  missing_ = has_rest_ ? static_cast<double>(missing) : 0;
  off_ = step_ = top_ = slack_ = 0;
  rows_ = 0;
  has_turned_ = false;
  if (free_ < 0 || model_.unwind_policy != UnwindPolicy::kRetract) {
    blame("the machine file has no unwinding", row);
  }
}

void UnwindCheck::check_turn(double off, const RecordingRow& row) {
  if (!has_turned_) top_ = off;
  has_turned_ = true;
  if (off + slack_ < model_.unwind_retract_mm - options_.tip_tolerance_mm) {
    blame("the redundant joint turns before the tool is off the part", row);
  } else if (std::abs(off - top_) > options_.tip_tolerance_mm) {
    blame("the tool moves while the redundant joint turns", row);
  }
}

void UnwindCheck::check(const RecordingRow& row) {
  const ToolPose pose = held_pose(row);
  const Vector3 by = pose.tip - begin_.tip;
  const double off = by.dot(begin_.axis);
  if (rows_ > 0) step_ = std::abs(off - off_) / static_cast<double>(row.cycle - last_.cycle);
  if (rows_++ == 1) slack_ = missing_ * step_;
  const bool is_on_line = (by - off * begin_.axis).norm() <= options_.tip_tolerance_mm &&
                          angle_between(pose.axis, begin_.axis) <= options_.axis_tolerance_rad;
  if (!is_on_line) blame("the tool leaves the line along its axis", row);
  if (off < -options_.tip_tolerance_mm - slack_) blame("the tool goes into the part", row);
  const double turned = std::remainder(row.joints[free_] - rest_[free_], kTurn_rad);
  if (has_rest_ && std::abs(turned) > options_.axis_tolerance_rad) check_turn(off, row);
  off_ = off;
}

/// `row` is the first behind it, last_ its last one.
void UnwindCheck::end(const RecordingRow& row) {
  const std::uint64_t missing = row.cycle - last_.cycle - 1;
  if (free_ < 0 || !has_rest_ || missing > kMaxMissing) return;
  const double slack = slack_ + static_cast<double>(missing) * step_;
  const ToolPose pose = forward(model_, tool_length_, missing == 0 ? row.joints : last_.joints);
  const bool is_back = (pose.tip - begin_.tip).norm() <= options_.tip_tolerance_mm + slack &&
                       angle_between(pose.axis, begin_.axis) <= options_.axis_tolerance_rad;
  if (!is_back) blame("the tool comes back to another place than it left", row);
}

bool UnwindCheck::add(const RecordingRow& row) {
  const bool is_unwinding = row.kind == MotionKind::kUnwind;
  if (is_unwinding) {
    if (!is_in_) begin(row);
    if (free_ >= 0) check(row);
  } else if (is_in_) {
    end(row);
  }
  is_in_ = is_unwinding;
  last_ = row;
  has_last_ = true;
  return is_unwinding;
}

void UnwindCheck::finish(CheckReport& report) {
  report.unwindings = count_;
  if (bad_ == 0) return;
  report.findings.push_back(
      {Finding::Kind::kUnwinding, std::string("unwinding: ") + what_, bad_cycle_, bad_line_, bad_});
}

}  // namespace meridian::record
