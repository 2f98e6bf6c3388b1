// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/restart.hpp"

#include <algorithm>

namespace meridian::cl {

void Restart::pass(const ClBlock& block) {
  ++blocks_;
  if (is_motion(block.kind)) at_ = block;
  if (block.kind == BlockKind::kTool) {
    tool_ = block;
    at_.reset();  // where the tool before stood is no place for this one
  }
  if (block.kind == BlockKind::kAuxiliary) pass_action(block);
}

void Restart::pass_action(const ClBlock& block) {
  switch (block.action) {
    case ActionKind::kSpindleOff:
      spindle_.reset();
      return;
    case ActionKind::kSpindleClockwise:
    case ActionKind::kSpindleCounterClockwise:
      spindle_ = block;
      return;
    case ActionKind::kCoolantOff:
      coolants_.clear();
      return;
    case ActionKind::kCoolantFlood:
    case ActionKind::kCoolantMist:
    case ActionKind::kCoolantThrough:
      if (std::none_of(coolants_.begin(), coolants_.end(),
                       [&block](const ClBlock& on) { return on.action == block.action; })) {
        coolants_.push_back(block);
      }
      return;
    default:
      if (vendor_line_ == 0) vendor_line_ = block.line;
  }
}

std::vector<ClBlock> Restart::state() const {
  std::vector<ClBlock> out;
  if (tool_) out.push_back(*tool_);
  if (spindle_) out.push_back(*spindle_);
  out.insert(out.end(), coolants_.begin(), coolants_.end());
  if (at_) {
    ClBlock there;
    there.kind = BlockKind::kRapid;
    there.line = at_->line;
    there.tip_mm = at_->tip_mm;
    there.axis = at_->axis;
    out.push_back(there);
  }
  return out;
}

}  // namespace meridian::cl
