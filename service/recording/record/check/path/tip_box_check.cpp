// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/tip_box_check.hpp"

#include <algorithm>
#include <cstdio>

#include "meridian/cycle/guard.hpp"
#include "meridian/kinematics/tip_over_base.hpp"

namespace meridian::record {

TipBoxCheck::TipBoxCheck(const MachineModel& model, const CheckedPath& path,
                         std::span<const LimitsFrom> soft_limits)
    : model_(model),
      path_(path),
      tool_(path),
      soft_limits_(soft_limits),
      has_boxes_(model.tip_box.is_set),
      tool_length_mm_(path.begin_tool_length_mm()) {
  for (const LimitsFrom& from : soft_limits) {
    has_boxes_ = has_boxes_ || from.limits.tip_box().is_set;
  }
}

void TipBoxCheck::check(const TipBox& box, const Array3& tip, const RecordingRow& row) {
  const bool has_before = cycle_ + 1 == row.cycle;
  const Array3 before = tip_over_base(model_, tool_length_mm_, has_before ? before_ : row.joints);
  const int axis =
      has_before ? axis_leaving(box, tip, before, kGuardTip) : axis_outside(box, tip, kGuardTip);
  if (axis < 0) return;
  const auto i = static_cast<std::size_t>(axis);
  outside_.add(beyond_face(box, i, tip[i]), row.cycle, row.line);
}

void TipBoxCheck::add(const RecordingRow& row, bool is_cut) {
  if (!has_boxes_) return;
  const bool is_approach = row.kind == MotionKind::kApproach && row.line == path_.begin_line();
  if (!is_leading(row.flags) || !(is_cut || is_approach)) return;
  if (is_cut) tool_length_mm_ = tool_.length_at(row.line);
  while (soft_limits_.size() > 1 && soft_limits_[1].cycle <= row.cycle) {
    soft_limits_ = soft_limits_.subspan(1);
  }
  const Array3 tip = tip_over_base(model_, tool_length_mm_, row.joints);
  check(model_.tip_box, tip, row);
  const bool is_known = !soft_limits_.empty() && soft_limits_.front().cycle <= row.cycle;
  if (is_known) check(soft_limits_.front().limits.tip_box(), tip, row);
  before_ = row.joints;
  cycle_ = row.cycle;
}

void TipBoxCheck::finish(CheckReport& report) const {
  if (outside_.count == 0) return;
  char text[128];
  std::snprintf(text, sizeof text, "the tip is outside of the tip box by up to %.6g mm",
                outside_.worst.value);
  report.findings.push_back(
      {Finding::Kind::kTravel, text, outside_.worst.cycle, outside_.worst.line, outside_.count});
}

}  // namespace meridian::record
