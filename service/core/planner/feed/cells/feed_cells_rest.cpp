// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "service/core/planner/feed/cells/feed_cells.hpp"

/// Cells beside the rests at both ends of a path. There the machine is slow: a cell that takes
/// 4 ms at full speed takes ten times as long, under one jerk that its worst sample bounds.
namespace meridian {

double CellGrid::length_from_rest(const FeedSpan& span, double x) const noexcept {
  JointVector reference = joints_;
  CellSample at;
  if (is_fault(sample(span, x, reference, at))) return std::numeric_limits<double>::infinity();
  // With u⃛ = j from rest, u̇ = j t²/2 and ü = j t: 1/j by the feed, and by the jerk of a joint,
  // q' j + 3/2 q'' j² t³ + q''' j³ t⁶/8.
  const double t = settings_.rest_s, cube = t * t * t;
  double per_jerk = 0.5 * t * t / std::sqrt(at.max_b);
  for (int i = 0; i < limits_.count; ++i) {
    const double full = limits_.full_jerk[i];
    per_jerk = std::max(per_jerk, std::abs(at.d1[i]) / full +
                                      std::sqrt(1.5 * cube * std::abs(at.d2[i]) / full) +
                                      0.5 * cube * std::cbrt(std::abs(at.d3[i]) / full) / t);
  }
  return std::max(cube / (6 * per_jerk), kMinRest_mm);
}

/// A draft, the nearest to the rest first, in pieces that are no longer than what lies before them
/// lets them be. `from_rest` is the length before it.
void CellGrid::draft_from_rest(Draft rest, double first, bool is_end, std::size_t to_come,
                               double& from_rest) noexcept {
  for (;;) {
    const double longest = std::max(first, kRestGrowth * from_rest);
    const bool has_room = finer_.size() + to_come + 2 < kDrafts;
    Draft piece = rest;
    if (has_room && rest.h > longest) piece.h = rest.h / std::ceil(rest.h / longest);
    if (is_end) piece.x = rest.x + (rest.h - piece.h);
    finer_.push_back(piece);
    from_rest += piece.h;
    if (!(piece.h < rest.h)) return;
    if (!is_end) rest.x += piece.h;
    rest.h -= piece.h;
  }
}

void CellGrid::grade_begin() noexcept {
  is_begin_graded_ = true;
  const FeedSpan& span = waiting_[static_cast<std::size_t>(drafts_.front().waiting)];
  if (span.cells > 0) return;
  const double first = length_from_rest(span, span.begin);
  double from_rest = 0;
  finer_.clear();
  for (std::size_t n = 0; n < drafts_.size(); ++n) {
    draft_from_rest(drafts_[n], first, false, drafts_.size() - n, from_rest);
  }
  added_at_begin_ = static_cast<std::int64_t>(finer_.size() - drafts_.size());
  drafts_.swap(finer_);
}

/// Of the last spans alone, none of whose cells are made yet whatever room there was for them.
void CellGrid::grade_end() noexcept {
  if (drafts_.empty() || waiting_count_ == 0) return;
  const FeedSpan& span = waiting_[static_cast<std::size_t>(waiting_count_ - 1)];
  if (span.cells > 0) return;
  const double first = length_from_rest(span, span.begin + span.length);
  double from_rest = 0;
  finer_.clear();
  for (std::size_t n = drafts_.size(); n-- > 0;) {
    if (drafts_[n].waiting < waiting_count_ - kAhead) {
      finer_.push_back(drafts_[n]);
    } else {
      draft_from_rest(drafts_[n], first, true, n, from_rest);
    }
  }
  std::reverse(finer_.begin(), finer_.end());
  drafts_.swap(finer_);
}

}  // namespace meridian
