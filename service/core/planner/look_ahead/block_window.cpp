// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/block_window.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meridian/kinematics/winding.hpp"

namespace meridian {

BlockWindow::BlockWindow(const MachineModel& model, bool is_used)
    : is_used_(is_used), blocks_(is_used ? 2 * kWaiting : 1), look_(model), reported_(kReported) {}

void BlockWindow::begin(const LookAheadSlack& slack) noexcept {
  blocks_.clear();
  next_ = 0;
  is_whole_ = false;
  questions_ = 0;
  slack_ = slack;
  reported_.clear();
}

void BlockWindow::keep(const ClBlock& block) noexcept {
  if (!is_used_) return;
  push(block);
  pop();
}

const ClBlock* BlockWindow::find(std::uint64_t sequence) const noexcept {
  const std::int64_t n = find_first(sequence), end = blocks_.end_index();
  const bool is_there = n < end && blocks_[n].sequence == sequence;
  return is_there && end - n <= static_cast<std::int64_t>(kWaiting) ? &blocks_[n] : nullptr;
}

const ClBlock* BlockWindow::find_motion_ahead(std::uint64_t sequence) const noexcept {
  for (std::int64_t n = find_first(sequence); n-- > blocks_.begin_index();) {
    if (is_motion(blocks_[n].kind)) return &blocks_[n];
  }
  return nullptr;
}

void BlockWindow::go_back_to(std::uint64_t sequence) noexcept {
  next_ = std::min(next_, find_first(sequence));
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

std::uint64_t BlockWindow::reported_for(std::uint64_t sequence) const noexcept {
  const auto is_of_it = [sequence](const FeedMark& mark) {
    return mark.looked_at > 0 && mark.sequence > 0 && mark.sequence == sequence;
  };
  for (std::int64_t n = reported_.end_index(); n-- > reported_.begin_index();) {
    if (is_of_it(reported_[n])) return reported_[n].looked_at;
  }
  const auto mark = std::find_if(marks_.rbegin(), marks_.rend(), is_of_it);
  return mark != marks_.rend() ? mark->looked_at : 0;
}

void BlockWindow::ask(const Start& start, std::span<const RouteAhead> routes) noexcept {
  ++questions_;
  asked_ = start;
  follows_ = find_first(start.sequence + (start.is_on_path ? 0 : 1));
  max_followed_ = kMaxFollowed;
  if (const std::uint64_t reported = reported_for(start.sequence); reported > 0) {
    const int followed = static_cast<int>(std::min<std::uint64_t>(reported, kWaiting));
    max_followed_ = start.is_on_path ? followed : followed - 1;
  }
  look_.begin(start.tool_length_mm, start.pose, slack_, routes);
}

ClBlock BlockWindow::rest_of(ClBlock block) const noexcept {
  if (!block.is_arc) return block;
  const Vector3 normal = to_vector(block.normal), centre = to_vector(block.centre_mm);
  const auto across = [&](const Vector3& tip) -> Vector3 {
    const Vector3 from = tip - centre;
    return from - normal.dot(from) * normal;
  };
  const Vector3 begin = across(asked_.pose.tip), end = across(to_vector(block.tip_mm));
  const double turn = std::atan2(normal.dot(begin.cross(end)), begin.dot(end));
  const double left = turn > 0 ? turn : turn + kTurn_rad;
  block.is_arc = left <= block.sweep_rad;  // else it starts where the arc ends
  block.sweep_rad = left;
  return block;
}

bool BlockWindow::look() noexcept {
  const auto is_answered = [this] {
    return look_.is_settled() || look_.followed() >= max_followed_;
  };
  for (; !is_answered() && follows_ < blocks_.end_index(); ++follows_) {
    const ClBlock& block = blocks_[follows_];
    if (block.sequence != asked_.sequence) {
      look_.follow(block);
    } else if (asked_.is_on_path) {
      look_.follow(rest_of(block));
    }
  }
  return is_answered() || is_whole_;
}

std::optional<FeedMark> BlockWindow::look_no_further() noexcept {
  if (!is_missing()) return {};
  max_followed_ = look_.followed();
  const int looked_at = std::max(1, max_followed_ + (asked_.is_on_path ? 0 : 1));
  const FeedMark mark{.sequence = asked_.sequence,
                      .looked_at = static_cast<std::uint64_t>(looked_at),
                      .is_late = true};
  reported_.push_over_oldest(mark);
  return mark;
}

}  // namespace meridian
