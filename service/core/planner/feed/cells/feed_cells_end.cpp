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
  struct Place {
    JointVector joints;
    LimitedVector values;
    CellSample at;
    [[nodiscard]] JointDerivatives derivatives() const noexcept {
      return {values, at.d1, at.d2, at.d3};
    }
  };
  const auto is_good = [&](double x, const JointVector& reference, Place& out) {
    out.joints = reference;
    if (is_fault(sample(span, x, out.joints, out.at))) return false;
    out.values = limited_of(model_, out.joints);
    return first_joint_outside_travel(model_, out.joints, kTravelMargin) < 0;
  };
  Place last, middle;
  if (!is_good(good, joints_, last)) return;
  for (int n = 0; n < kFaultHalvings; ++n) {
    const double step = 0.5 * (faulty_x_ - good);
    if (is_good(good + step, last.joints, middle) &&
        !is_fault(check_between(last.derivatives(), middle.derivatives(), step))) {
      good += step;
      last = middle;
    } else {
      faulty_x_ = good + step;
    }
  }
}

void CellGrid::end_at(const JointSpan& span, std::uint64_t number, double x,
                      std::int64_t smallest) noexcept {
  const auto begins_before = [&](const FeedCell& cell) {
    return cell.span < number || (cell.span == number && cell.x < x - kNoCell_mm);
  };
  fault_ = {};
  is_finished_ = is_begin_graded_ = true;
  drafts_.clear();
  waiting_count_ = 0;
  const std::int64_t kept = std::max(first_, smallest);
  while (last_ > kept && !begins_before((*this)[last_ - 1])) --last_;
  double begin = 0;  // of the cell that ends at x
  if (last_ > first_) {
    const FeedCell& cell = (*this)[last_ - 1];
    const double end = cell.x + cell.h;
    if (cell.span == number && end > x + kNoCell_mm) {
      if (last_ == kept) return;
      begin = cell.x;
      --last_;
    } else if (cell.span == number) {
      begin = end;
    } else if (cell.span + 1 != number) {
      return;
    }
  }
  if (x - begin <= kNoCell_mm) return;
  // On a sliver of a cell the path would end from all but a rest, and a plan swings back there.
  if (last_ > kept) {
    const FeedCell& before = (*this)[last_ - 1];
    if (before.span == number && x - begin < before.h / kRatio) {
      begin = before.x;
      --last_;
    }
  }
  waiting_[0] = make_feed_span(span, tool_length_mm_);
  waiting_count_ = 1;
  next_span_ = number;
  drafts_.push_back({0, begin, x - begin});
  if (make_cells().kind == PathFault::Kind::kNone) return;
  fault_ = {};  // it ends a cell earlier
  drafts_.clear();
}

}  // namespace meridian
