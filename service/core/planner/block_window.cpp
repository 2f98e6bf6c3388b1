// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/block_window.hpp"

#include <algorithm>

namespace meridian {

BlockWindow::BlockWindow(const MachineModel& model, bool is_used)
    : is_used_(is_used), blocks_(is_used ? 2 * kWaiting : 1), look_(model) {}

void BlockWindow::begin(const AheadSlack& slack) noexcept {
  blocks_.clear();
  next_ = 0;
  is_whole_ = is_asked_ = false;
  slack_ = slack;
  late_ = {};
}

void BlockWindow::keep(const ClBlock& block) noexcept {
  if (!is_used_) return;
  push(block);
  pop();
}

std::int64_t BlockWindow::find_first(std::uint64_t sequence) const noexcept {
  // The oldest that is looked at follows from what was planned, not from what waits.
  std::int64_t low = std::max(blocks_.begin_index(), next_ - kKept), high = blocks_.end_index();
  while (low < high) {
    const std::int64_t middle = (low + high) / 2;
    if (blocks_[middle].sequence < sequence) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

std::uint64_t BlockWindow::told_for(std::uint64_t sequence) const noexcept {
  if (late_.looked_at > 0 && late_.sequence == sequence) return late_.looked_at;
  for (const FeedMark& mark : marks_) {
    if (mark.looked_at > 0 && mark.sequence > 0 && mark.sequence == sequence) return mark.looked_at;
  }
  return 0;
}

void BlockWindow::ask(const Start& start, std::span<const AheadWay> ways) noexcept {
  is_asked_ = true;
  is_forced_ = false;
  is_on_its_way_ = start.is_on_its_way;
  asked_ = start.sequence;
  follows_ = find_first(asked_);
  const std::uint64_t told = told_for(asked_);
  most_ = static_cast<int>(told > 0 ? std::min<std::uint64_t>(told, kWaiting) : kWaiting);
  look_.begin(start.tool_length_mm, start.pose, slack_, ways);
}

bool BlockWindow::look() noexcept {
  const auto is_answered = [this] {
    return is_forced_ || look_.is_settled() || look_.followed() >= most_;
  };
  for (; !is_answered() && follows_ < blocks_.end_index(); ++follows_) {
    ClBlock block = blocks_[follows_];
    if (is_on_its_way_ && look_.followed() == 0) block.is_arc = false;  // what is left is short
    look_.follow(block);
  }
  return is_answered() || is_whole_;
}

std::optional<FeedMark> BlockWindow::look_no_further() noexcept {
  if (!is_missing()) return {};
  is_forced_ = true;
  const int looked_at = std::max(1, look_.followed());
  late_ = {.sequence = asked_, .looked_at = static_cast<std::uint64_t>(looked_at), .is_late = true};
  return late_;
}

}  // namespace meridian
