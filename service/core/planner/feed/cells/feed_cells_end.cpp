// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"

/// Where a path lies that cannot go on, and where it ends then.
namespace meridian {
namespace {

constexpr double kNoCell_mm = 1e-6;  // of u: an end that is not worth a cell
constexpr int kFaultHalvings = 16;   // of the step of the samples: 1 mm becomes 15 nm

}  // namespace

bool CellGrid::leaves_reach(const Draft& draft) const noexcept {
  const FeedSpan& span = waiting_[static_cast<std::size_t>(draft.waiting)];
  JointVector reference = joints_;
  CellSample end;
  return is_fault(sample(span, span.length, reference, end));
}

void CellGrid::narrow_fault(const Draft& draft) noexcept {
  const FeedSpan& span = waiting_[static_cast<std::size_t>(draft.waiting)];
  if (!(faulty_x_ > draft.x)) return;  // it begins with the fault
  double good = std::max(draft.x, faulty_x_ - draft.h / FeedCell::kSteps);
  struct JointSample {
    JointVector joints;
    LimitedVector values;
    CellSample at;
    [[nodiscard]] JointDerivatives derivatives() const noexcept {
      return {values, at.d1, at.d2, at.d3};
    }
  };
  const auto is_good = [&](double x, const JointVector& reference, JointSample& out) {
    out.joints = reference;
    if (is_fault(sample(span, x, out.joints, out.at))) return false;
    out.values = limited_of(model_, out.joints);
    return first_joint_outside_travel(model_, out.joints, kTravelMargin) < 0;
  };
  JointSample last, middle;
  if (!is_good(good, joints_, last)) return;
  for (int n = 0; n < kFaultHalvings; ++n) {
    const double step = 0.5 * (faulty_x_ - good);
    if (is_good(good + step, last.joints, middle) &&
        !is_fault(check_between(span.path.kind, last.derivatives(), middle.derivatives(), step))) {
      good += step;
      last = middle;
    } else {
      faulty_x_ = good + step;
    }
  }
}

void CellGrid::cut_drafts(std::uint64_t number, double x) noexcept {
  const auto number_of = [&](const Draft& draft) {
    return next_span_ + static_cast<std::uint64_t>(draft.waiting);
  };
  const auto is_beyond = [&](const Draft& draft) {
    return number_of(draft) > number || (number_of(draft) == number && draft.x >= x - kNoCell_mm);
  };
  while (!drafts_.empty() && is_beyond(drafts_.back())) drafts_.pop_back();
  if (drafts_.empty()) return;
  Draft& last = drafts_.back();
  if (number_of(last) == number) last.h = std::min(last.h, x - last.x);
}

void CellGrid::cut_cells(const JointSpan& span, std::uint64_t number, double x,
                         std::int64_t kept) noexcept {
  const auto begins_before = [&](const FeedCell& cell) {
    return cell.span < number || (cell.span == number && cell.x < x - kNoCell_mm);
  };
  waiting_count_ = 0;
  while (last_ > kept && !begins_before((*this)[last_ - 1])) --last_;
  if (last_ == kept) return;
  const FeedCell& cell = (*this)[last_ - 1];
  if (cell.span != number || cell.x + cell.h <= x + kNoCell_mm) return;
  waiting_[0] = make_feed_span(span, tool_length_mm_);
  waiting_count_ = 1;
  next_span_ = number;
  drafts_.push_back({0, cell.x, x - cell.x});
  --last_;
}

void CellGrid::join_sliver(std::int64_t kept) noexcept {
  const std::size_t count = drafts_.size();
  Draft& last = drafts_.back();
  if (count > 1) {
    Draft& before = drafts_[count - 2];
    if (before.waiting != last.waiting || last.h >= before.h / kRatio) return;
    before.h += last.h;
    drafts_.pop_back();
  } else if (last_ > kept) {
    const FeedCell& before = (*this)[last_ - 1];
    const std::uint64_t number = next_span_ + static_cast<std::uint64_t>(last.waiting);
    if (before.span != number || last.h >= before.h / kRatio) return;
    last.h += last.x - before.x;
    last.x = before.x;
    --last_;
  }
}

void CellGrid::end_at(const JointSpan& span, std::uint64_t number, double x,
                      std::int64_t smallest) noexcept {
  fault_ = {};
  is_finished_ = true;
  const std::int64_t kept = std::max(first_, smallest);
  cut_drafts(number, x);
  if (drafts_.empty()) cut_cells(span, number, x, kept);
  if (drafts_.empty()) return;
  join_sliver(kept);
  halve_short_path();
  const Draft last = drafts_.back();
  const std::uint64_t end_span = next_span_ + static_cast<std::uint64_t>(last.waiting);
  if (!is_fault(make_cells())) return;
  if (faulty_span_ < end_span || drafts_.front().x < last.x) return;
  fault_ = {};  // it ends a cell earlier
  drafts_.clear();
}

}  // namespace meridian
