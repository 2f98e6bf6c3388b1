// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/planner/motion_port.hpp"
#include "service/core/planner/feed/rolling/rolling_feed.hpp"

/// What stands of a planned window, and its tail.
namespace meridian {
namespace {

/// Pieces of a tail: the cycle skips all of them in one call, and has places left for paths.
constexpr std::size_t kMaxTail = MotionReader::kMaxDrops - 8;
constexpr int kOntoBraking = 30;  // cells over which a plan changes from going on to braking

}  // namespace

/// What a plan does ahead of its braking to rest hardly depends on where that rest is: the fewer
/// windows the better. The braking itself is planned again.
int RollingFeed::cells_to_keep(const Plan& plan) const noexcept {
  int braking = plan.cells();
  while (braking > 0 && plan.b[braking - 1] >= plan.b[braking]) --braking;
  const int free =
      std::clamp(braking - kOntoBraking, settings_.commit_cells, plan.max_commit_cells);
  return std::min(free, plan.cells());
}

/// Index of the first piece of the tail behind `kept` cells, or of as many more as it takes for the
/// tail to be short enough; `kept` is then those.
std::size_t RollingFeed::find_tail(std::int64_t first, int& kept) const noexcept {
  const auto& pieces = pieces_.all();
  std::size_t tail = pieces.size();
  while (tail > 0 && pieces[tail - 1].cell >= first + kept) --tail;
  if (pieces.size() - tail <= kMaxTail) return tail;
  tail = pieces.size() - kMaxTail;
  while (pieces[tail].cell == pieces[tail - 1].cell) ++tail;
  kept = static_cast<int>(pieces[tail].cell - first);
  return tail;
}

void RollingFeed::commit(bool is_new) noexcept {
  pieces_.clear();
  Plan& plan = is_new ? new_ : old_;
  const bool is_start = is_new && is_at_rest_;
  if (is_start) pieces_.add(grid_[next_], next_, start_, true);
  if (!is_new) {  // what is left of the old plan
    const auto skipped = static_cast<std::ptrdiff_t>(next_ - plan.first);
    std::move(plan.b.begin() + skipped, plan.b.begin() + plan.cells() + 1, plan.b.begin());
    std::move(plan.slope.begin() + skipped, plan.slope.begin() + plan.cells() + 1,
              plan.slope.begin());
    plan.first = next_;
  }
  const int cells = plan.cells();
  const bool is_last = grid_.is_complete() && plan.end == grid_.last();
  const bool is_whole = is_last || (!is_new && cells <= settings_.commit_cells);
  for (int k = 0; k < cells; ++k) {
    const std::int64_t number = plan.first + k;
    pieces_.add(grid_[number], number, {plan.b[k], plan.slope[k], plan.slope[k + 1]});
  }
  pieces_.add(grid_[plan.end - 1], plan.end - 1, plan.stop, false);
  // Of the plan before there was room for all, and a crawl has few.
  if (is_new && pieces_.is_cut_short()) {
    if (is_at_rest_) return commit_crawl();
    ++count_.kept;
    return commit(false);
  }
  const std::span<const FeedPiece> all = pieces_.all();
  int kept = is_whole ? cells : cells_to_keep(plan);
  const std::size_t tail = is_whole ? all.size() : find_tail(plan.first, kept);
  window_ = {is_start, all.first(tail), all.subspan(tail), plan.end};
  next_ = is_whole ? plan.end : plan.first + kept;
  is_at_rest_ = is_whole;
  if (is_whole) {
    count_.stops += is_last ? 0 : 1;
  } else {
    state_ = {plan.b[kept], plan.slope[kept]};
  }
  if (is_new) std::swap(old_, new_);
}

void RollingFeed::commit_crawl() noexcept {
  ++count_.crawls;
  pieces_.clear();
  Crawl best;
  for (const int wanted : {3, 6, 12, 24, 48}) {
    const int cells = static_cast<int>(std::min<std::int64_t>(wanted, window_end() - next_));
    const Crawl crawl = checked(limits_, grid_, next_, crawl_over(grid_, planned_, next_, cells));
    const bool is_faster =
        best.cells == 0 || crawl.length * best.duration > best.length * crawl.duration;
    if (is_faster) best = crawl;
  }
  pieces_.add(grid_, next_, best);
  next_ += best.cells;
  old_.first = old_.end = next_;
  window_ = {true, pieces_.all(), {}, next_};
}

}  // namespace meridian
