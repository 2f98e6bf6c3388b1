// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/rewind_check.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/winding.hpp"
#include "service/recording/record/check/path/towards_pole.hpp"

namespace meridian::record {

RewindCheck::RewindCheck(const MachineModel& model, const CheckedPath& path,
                         const CheckOptions& options)
    : model_(model), tool_(path), options_(options), free_(redundant_joint(model)) {}

void RewindCheck::blame(const char* what, const RecordingRow& row) {
  if (bad_++ > 0) return;
  what_ = what;
  bad_cycle_ = row.cycle;
  bad_line_ = row.line;
}

/// With the redundant joint where it was: what its turns do to the tool is no matter of the line.
ToolPose RewindCheck::held_pose(const RecordingRow& row) const {
  JointVector held = row.joints;
  held[free_] = held_;
  return forward(model_, tool_length_, held);
}

bool RewindCheck::is_on_line(const ToolPose& pose) const {
  const Vector3 by = pose.tip - begin_.tip;
  return (by - by.dot(begin_.axis) * begin_.axis).norm() <= options_.tip_tolerance_mm &&
         angle_between(pose.axis, begin_.axis) <= options_.axis_tolerance_rad;
}

bool RewindCheck::is_tilted(const ToolPose& pose) const {
  return is_on_line({pose.tip, begin_.axis}) &&
         is_towards_pole(model_, begin_.axis, pose.axis, options_.axis_tolerance_rad);
}

void RewindCheck::begin(const RecordingRow& row) {
  ++count_;
  const std::uint64_t missing = has_last_ ? row.cycle - last_.cycle - 1 : kMaxMissing + 1;
  has_rest_ = missing <= kMaxMissing;
  rest_ = missing == 0 ? last_.joints : row.joints;
  tool_length_ = tool_.length_at(row.line);
  begin_ = forward(model_, tool_length_, rest_);
  missing_ = has_rest_ ? static_cast<double>(missing) : 0;
  off_ = step_ = top_ = slack_ = 0;
  rows_ = 0;
  has_turned_ = has_tilted_ = false;
  held_ = free_ >= 0 ? rest_[free_] : 0;
  if (free_ < 0 || model_.rewind_policy != RewindPolicy::kRetract) {
    blame("the machine file has no rewind", row);
  }
}

void RewindCheck::check_turn(double off, const RecordingRow& row) {
  if (!has_turned_) top_ = off;
  has_turned_ = true;
  if (off + slack_ < model_.rewind_retract_mm - options_.tip_tolerance_mm) {
    blame("the redundant joint turns before the tool is off the part", row);
  } else if (std::abs(off - top_) > options_.tip_tolerance_mm) {
    blame("the tool moves while the redundant joint turns", row);
  }
}

void RewindCheck::check(const RecordingRow& row) {
  const ToolPose there = forward(model_, tool_length_, row.joints);
  if (has_tilted_ && is_on_line(there)) held_ = row.joints[free_];  // on the other branch
  ToolPose pose = held_pose(row);
  const bool is_tilting = !is_on_line(pose) && is_tilted(there);
  if (is_tilting) pose = there;
  const double off = (pose.tip - begin_.tip).dot(begin_.axis);
  if (rows_ > 0) step_ = std::abs(off - off_) / static_cast<double>(row.cycle - last_.cycle);
  if (rows_++ == 1) slack_ = missing_ * step_;
  if (!is_tilting && !is_on_line(pose)) blame("the tool leaves the line along its axis", row);
  if (off < -options_.tip_tolerance_mm - slack_) blame("the tool goes into the part", row);
  has_tilted_ |= is_tilting;
  const double turned = std::remainder(row.joints[free_] - held_, kTurn_rad);
  const bool turns = is_tilting || std::abs(turned) > options_.axis_tolerance_rad;
  if (has_rest_ && turns) check_turn(off, row);
  off_ = off;
}

/// `row` is the first behind it, last_ its last one.
void RewindCheck::end(const RecordingRow& row) {
  const std::uint64_t missing = row.cycle - last_.cycle - 1;
  if (free_ < 0 || !has_rest_ || missing > kMaxMissing) return;
  const double slack = slack_ + static_cast<double>(missing) * step_;
  const ToolPose pose = forward(model_, tool_length_, missing == 0 ? row.joints : last_.joints);
  const bool is_back = (pose.tip - begin_.tip).norm() <= options_.tip_tolerance_mm + slack &&
                       angle_between(pose.axis, begin_.axis) <= options_.axis_tolerance_rad;
  if (!is_back) blame("the tool comes back to another place than it left", row);
}

bool RewindCheck::add(const RecordingRow& row) {
  const bool is_rewind = row.kind == MotionKind::kRewind;
  if (is_rewind) {
    if (!is_in_) begin(row);
    if (free_ >= 0) check(row);
  } else if (is_in_) {
    end(row);
  }
  is_in_ = is_rewind;
  last_ = row;
  has_last_ = true;
  return is_rewind;
}

void RewindCheck::finish(CheckReport& report) {
  report.rewinds = count_;
  if (bad_ == 0) return;
  report.findings.push_back(
      {Finding::Kind::kRewind, std::string("rewind: ") + what_, bad_cycle_, bad_line_, bad_});
}

}  // namespace meridian::record
