// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/feed/cells/feed_rounding.hpp"

namespace meridian {
namespace {

constexpr double kLargestJump = 1.0;  // rad between two samples: another branch, no path
/// Of a joint at the begin: rounding, 1e-10 rad of the redundant joint 8 µrad from the pole, and of
/// slides that make up for it so much of their way to its axis.
constexpr double kStep_mm = 1e-7, kStep_rad = 1e-9;
constexpr int kHalvings = 16;  // of halving: lengths of a ratio of 60 000

/// The range of the samples, and an eighth of it either side for what lies between.
CellBound bound_of(const std::array<CellSample, FeedCell::kSteps + 1>& at) noexcept {
  constexpr double kBetween = 0.125;
  CellBound out;
  const auto bound = [&](LimitedVector CellSample::*d, CellBound::Sides& sides) {
    for (std::size_t i = 0; i < kMaxLimited; ++i) {
      double low = (at[0].*d)[i], high = low;
      for (const CellSample& sample : at) {
        low = std::min(low, (sample.*d)[i]);
        high = std::max(high, (sample.*d)[i]);
      }
      const double beyond = kBetween * (high - low);
      const auto n = static_cast<Eigen::Index>(i);
      sides.up[n] = std::max(0.0, high + beyond);
      sides.down[n] = std::max(0.0, beyond - low);
    }
  };
  bound(&CellSample::d1, out.d1);
  bound(&CellSample::d2, out.d2);
  bound(&CellSample::d3, out.d3);
  out.rate = out.d1.up.max(out.d1.down);
  return out;
}

/// Whether a joint jumps from one sample to the next, or at all at the same point.
PathFault check_step(const MachineModel& model, const JointVector& before, const JointVector& here,
                     bool is_same_point) noexcept {
  for (int i = 0; i < model.joint_count; ++i) {
    const double jump = here[i] - before[i];
    const double rounding = model.joints[i].is_rotary ? kStep_rad : kStep_mm;
    const bool is_jump = (is_same_point && std::abs(jump) > rounding) ||
                         (model.joints[i].is_rotary && std::abs(jump) > kLargestJump);
    if (is_jump) return {PathFault::Kind::kJump, i, jump};
  }
  return {};
}

}  // namespace

CellGrid::CellGrid(const MachineModel& model, const FeedLimits& limits,
                   const CellSettings& settings)
    : model_(model),
      limits_(limits),
      settings_(settings),
      cells_(static_cast<std::size_t>(settings.kept_cells)) {
  drafts_.reserve(kDrafts);
  finer_.reserve(kDrafts);
}

void CellGrid::begin(const JointVector& joints, double tool_length_mm) noexcept {
  waiting_count_ = 0;
  drafts_.clear();
  next_span_ = 0;
  first_ = last_ = 0;
  last_h_ = 0;
  added_at_begin_ = 0;
  joints_ = joints;
  tool_length_mm_ = tool_length_mm;
  is_finished_ = is_begin_graded_ = false;
  fault_ = {};
}

void CellGrid::halve(double left, double ratio, int rounds) noexcept {
  for (int round = 0; round < rounds; ++round) {
    finer_.clear();
    bool is_changed = false;
    for (std::size_t n = 0; n < drafts_.size(); ++n) {
      const Draft& draft = drafts_[n];
      const double before = n > 0 ? drafts_[n - 1].h : left;
      const double after = n + 1 < drafts_.size() ? drafts_[n + 1].h : draft.h;
      const bool is_long = draft.h > ratio * before || draft.h > ratio * after;
      const std::size_t needed = finer_.size() + 2 + drafts_.size() - n;
      if (!is_long || needed > kDrafts) {
        finer_.push_back(draft);
        continue;
      }
      finer_.push_back({draft.waiting, draft.x, 0.5 * draft.h});
      finer_.push_back({draft.waiting, draft.x + 0.5 * draft.h, 0.5 * draft.h});
      is_changed = true;
    }
    drafts_.swap(finer_);
    if (!is_changed) return;
  }
}

PathFault CellGrid::push(const FeedSpan& span) noexcept {
  if (fault_.kind != PathFault::Kind::kNone) return fault_;
  if (!(span.length > 0)) return {};
  waiting_[static_cast<std::size_t>(waiting_count_++)] = span;
  draft_cells(span);
  halve(last_ > 0 ? last_h_ : std::numeric_limits<double>::infinity(), kRatio, kHalvings);
  return make_cells();
}

PathFault CellGrid::finish() noexcept {
  if (fault_.kind != PathFault::Kind::kNone) return fault_;
  is_finished_ = true;
  halve_short_path();
  grade_end();
  return make_cells();
}

void CellGrid::halve_short_path() noexcept {
  while (last_ == 0 && !drafts_.empty() && drafts_.size() < kMin) {
    halve(std::numeric_limits<double>::infinity(), 0, 1);
  }
}

PathFault CellGrid::make_cells() noexcept {
  std::size_t used = 0;
  while (used < drafts_.size() && last_ - first_ < settings_.kept_cells) {
    const int after = waiting_count_ - 1 - drafts_[used].waiting;
    const bool is_long_enough = last_ > 0 || drafts_.size() - used >= kMin;
    if (!is_finished_ && (after < kAhead || !is_long_enough)) break;
    if (!is_begin_graded_) grade_begin();
    fault_ = make_cell(drafts_[used]);
    if (fault_.kind == PathFault::Kind::kJump && split(used)) {
      fault_ = {};
      continue;
    }
    if (fault_.kind == PathFault::Kind::kJump && leaves_reach(drafts_[used])) {
      fault_ = {PathFault::Kind::kUnreachable, -1, 0};
    }
    if (fault_.kind != PathFault::Kind::kNone) {
      faulty_span_ = next_span_ + static_cast<std::uint64_t>(drafts_[used].waiting);
      narrow_fault(drafts_[used]);
      break;
    }
    ++used;
  }
  if (used == 0) return fault_;
  drafts_.erase(drafts_.begin(), drafts_.begin() + static_cast<std::ptrdiff_t>(used));
  const int gone = drafts_.empty() ? waiting_count_ : drafts_.front().waiting;
  for (int n = gone; gone > 0 && n < waiting_count_; ++n) waiting_[n - gone] = waiting_[n];
  for (Draft& draft : drafts_) draft.waiting -= gone;
  waiting_count_ -= gone;
  next_span_ += static_cast<std::uint64_t>(gone);
  return fault_;
}

PathFault CellGrid::check_between(PathKind kind, const JointDerivatives& a,
                                  const JointDerivatives& b, double h) const noexcept {
  PathFault fault = check_turns(model_, a.q, a.d1, b.q, b.d1, h);
  if (!is_fault(fault) && kind != PathKind::kJoint) fault = check_joins(model_, a, b, h);
  if (has_boxes(model_) && !is_fault(fault)) {
    fault = check_boxes(model_, tool_length_mm_, a, b, h);
  }
  return fault;
}

PathFault CellGrid::make_cell(const Draft& draft) noexcept {
  const FeedSpan& span = waiting_[static_cast<std::size_t>(draft.waiting)];
  FeedCell& cell = (*this)[last_];
  cell.span = next_span_ + static_cast<std::uint64_t>(draft.waiting);
  cell.x = draft.x;
  cell.h = draft.h;
  cell.max_b = std::numeric_limits<double>::infinity();
  JointVector reference = joints_;
  JointVector begin{};
  LimitedVector values{};  // at the sample before
  for (int k = 0; k <= FeedCell::kSteps; ++k) {
    CellSample& at = cell.at[static_cast<std::size_t>(k)];
    const double x = draft.x + draft.h * k / FeedCell::kSteps;
    faulty_x_ = x;
    const JointVector before = reference;
    if (const auto fault = sample(span, x, reference, at); is_fault(fault)) return fault;
    cell.max_b = std::min(cell.max_b, at.max_b);
    if (const int joint = first_joint_outside_travel(model_, reference, kTravelMargin);
        joint >= 0) {
      return {PathFault::Kind::kTravel, joint, limited_value(model_, reference, joint)};
    }
    const LimitedVector here = limited_of(model_, reference);
    if (k > 0) {
      const CellSample& last = cell.at[static_cast<std::size_t>(k - 1)];
      const double step = draft.h / FeedCell::kSteps;
      const PathFault fault = check_between(span.path.kind, {values, last.d1, last.d2, last.d3},
                                            {here, at.d1, at.d2, at.d3}, step);
      if (is_fault(fault)) return fault;
    }
    values = here;
    if (k == 0) begin = reference;
    // No step between where the machine rests, or a robot's cell ended, and here: a span that is
    // driven past a singular place and the next one may not agree.
    const bool is_same_point = k == 0 && (last_ == 0 || model_.family == MachineFamily::kRobot);
    if (const auto fault = check_step(model_, before, reference, is_same_point); is_fault(fault)) {
      return fault;
    }
  }
  joints_ = reference;
  cell.bound = bound_of(cell.at);
  const auto share_at = [&](double x, const JointVector& joints) {
    return share_beside_singularity(model_, limits_, span.path, x, joints);
  };
  cell.tight = std::min(share_at(draft.x, begin), share_at(draft.x + draft.h, joints_));
  cell.made_b = cell.max_b;
  cell.made_tight = cell.tight;
  last_h_ = cell.h;
  ++last_;
  return {};
}

double CellGrid::max_b_at(std::int64_t cell) const noexcept {
  double b = std::numeric_limits<double>::infinity();
  if (cell > first_) b = (*this)[cell - 1].max_b;
  if (cell < last_) b = std::min(b, (*this)[cell].max_b);
  return b;
}

}  // namespace meridian
