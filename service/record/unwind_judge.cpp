// SPDX-License-Identifier: Apache-2.0
#include "service/record/unwind_judge.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"

namespace meridian::record {

UnwindJudge::UnwindJudge(const MachineModel& model, double tool_length_mm,
                         const CheckOptions& options)
    : model_(model), tool_length_(tool_length_mm), options_(options), free_(free_joint(model)) {}

void UnwindJudge::blame(const char* what, const RecordingRow& row) {
  if (bad_++ > 0) return;
  what_ = what;
  bad_cycle_ = row.cycle;
  bad_line_ = row.line;
}

void UnwindJudge::begin(const RecordingRow& row) {
  ++count_;
  has_rest_ = has_last_ && last_.cycle + 1 == row.cycle;
  rest_ = line_ = has_rest_ ? last_.joints : row.joints;
  begin_ = forward(model_, tool_length_, rest_);
  off_ = 0;
  if (free_ < 0 || model_.unwind_policy != UnwindPolicy::kRetract) {
    blame("the machine file has no unwinding", row);
  }
}

void UnwindJudge::judge(const RecordingRow& row) {
  const ToolPose pose = forward(model_, tool_length_, row.joints);
  const Vector3 by = pose.tip - begin_.tip;
  const double off = by.dot(begin_.axis);
  const bool is_on_line = (by - off * begin_.axis).norm() <= options_.tip_tolerance_mm &&
                          angle_between(pose.axis, begin_.axis) <= options_.axis_tolerance_rad;
  if (is_on_line) {
    if (off < -options_.tip_tolerance_mm) blame("the tool goes into the part", row);
    line_ = row.joints;
    off_ = off;
    return;
  }
  bool is_free_alone = true;
  for (int i = 0; i < model_.joint_count; ++i) {
    const double allowed =
        model_.joints[i].is_rotary ? options_.axis_tolerance_rad : options_.tip_tolerance_mm;
    is_free_alone &= i == free_ || std::abs(row.joints[i] - line_[i]) <= allowed;
  }
  if (!is_free_alone) {
    blame("the tool leaves the line along its axis", row);
  } else if (has_rest_ && off_ < model_.unwind_retract_mm - options_.tip_tolerance_mm) {
    blame("the free joint turns before the tool is off the part", row);
  }
}

void UnwindJudge::end(const RecordingRow& row) {
  if (!has_rest_ || last_.cycle + 1 != row.cycle || free_ < 0) return;
  const ToolPose pose = forward(model_, tool_length_, row.joints);
  const bool is_back = (pose.tip - begin_.tip).norm() <= options_.tip_tolerance_mm &&
                       angle_between(pose.axis, begin_.axis) <= options_.axis_tolerance_rad;
  if (!is_back) blame("the tool comes back to another place than it left", row);
}

bool UnwindJudge::add(const RecordingRow& row) {
  const bool is_unwinding = row.kind == MotionKind::kUnwind;
  if (is_unwinding) {
    if (!is_in_) begin(row);
    if (free_ >= 0) judge(row);
  } else if (is_in_) {
    end(row);
  }
  is_in_ = is_unwinding;
  last_ = row;
  has_last_ = true;
  return is_unwinding;
}

void UnwindJudge::finish(CheckReport& report) {
  report.unwindings = count_;
  if (bad_ == 0) return;
  report.findings.push_back(
      {Finding::Kind::kUnwinding, std::string("unwinding: ") + what_, bad_cycle_, bad_line_, bad_});
}

}  // namespace meridian::record
