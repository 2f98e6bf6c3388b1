// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"

/// How many cells a span becomes, and where they lie.
namespace meridian {
namespace {

constexpr double kMinSplit_mm = 5e-4;  // of u: below, motion would creep
constexpr double kMaxCells = 2;        // of time, that one takes where it is slowest
constexpr double kUneven = 1.05;       // of the time per u within a span: it is about a bend
constexpr double kFiner = 2;           // times as many cells there

}  // namespace

double CellGrid::time_at(const FeedSpan& span, double x) const noexcept {
  JointVector reference = joints_;
  CellSample at;
  return is_fault(sample(span, x, reference, at)) ? 0 : time_per_u(limits_, at);
}

int CellGrid::cells_of(const FeedSpan& span) const noexcept {
  if (span.cells > 0) return span.cells;
  constexpr int kProbes = 4;
  double time = 0, slowest = 0, fastest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kProbes; ++k) {
    const double here = time_at(span, span.begin + span.length * (k + 0.5) / kProbes);
    time += here / kProbes;
    slowest = std::max(slowest, here);
    fastest = std::min(fastest, here);
  }
  // About a bend the slowest place of a cell bounds all of it. Where the machine cannot be the path
  // ends anyway, and cells beside inner singularities are graded one by one.
  const bool is_bend = fastest > 0 && !has_inner_singularities(model_);
  if (is_bend && slowest > kUneven * fastest) time = kFiner * slowest;
  time *= span.length;
  return static_cast<int>(std::ceil(std::min(time / settings_.cell_s, 1.0 * kMaxPerSpan)));
}

void CellGrid::draft_cells(const FeedSpan& span) noexcept {
  const int room = kDrafts - static_cast<int>(drafts_.size()) - kWaiting;
  const int cells = std::clamp(cells_of(span), 1, std::clamp(room, 1, kMaxPerSpan));
  const double h = span.length / cells;
  // A span that says how many cells it becomes is graded already.
  const auto max = std::min<std::size_t>(drafts_.size() + kMaxGraded, kDrafts - kWaiting);
  const bool is_graded = has_inner_singularities(model_) && span.cells == 0;
  for (int k = 0; k < cells; ++k) {
    if (is_graded) {
      draft_graded(span, span.begin + k * h, h, max - static_cast<std::size_t>(cells - 1 - k));
    } else {
      drafts_.push_back({waiting_count_ - 1, span.begin + k * h, h});
    }
  }
}

void CellGrid::draft_graded(const FeedSpan& span, double x, double h, std::size_t max) noexcept {
  const double slowest =
      std::max({time_at(span, x), time_at(span, x + 0.5 * h), time_at(span, x + h)});
  const bool has_room = drafts_.size() + 2 <= max;
  if (slowest * h > kMaxCells * settings_.cell_s && h > kMinSplit_mm && has_room) {
    draft_graded(span, x, 0.5 * h, max - 1);
    draft_graded(span, x + 0.5 * h, 0.5 * h, max);
  } else {
    drafts_.push_back({waiting_count_ - 1, x, h});
  }
}

/// Beside an inner singularity joints turn sharply: into halves, as long as there is room.
bool CellGrid::split(std::size_t draft) noexcept {
  if (!has_inner_singularities(model_) || drafts_.size() == drafts_.capacity() ||
      drafts_[draft].h < kMinSplit_mm) {
    return false;
  }
  Draft half = drafts_[draft];
  half.h = drafts_[draft].h *= 0.5;
  half.x += half.h;
  drafts_.insert(drafts_.begin() + static_cast<std::ptrdiff_t>(draft) + 1, half);
  return true;
}

}  // namespace meridian
