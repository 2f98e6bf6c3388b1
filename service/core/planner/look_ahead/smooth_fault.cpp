// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "meridian/planner/joints_at.hpp"
#include "service/core/planner/look_ahead/smooth_run.hpp"

/// Where a smooth run ends that cannot go on: which block is named, and the rest ahead of it. Part
/// of SmoothRun.
namespace meridian {

/// Names the block that lies where the feed found a fault.
void SmoothRun::fail_on_span() noexcept {
  const auto number = static_cast<std::int64_t>(feed_.faulty_span());
  const BandSpan& span = spans_[number].band;
  fail(feed_.fault(), span.sequence, span.line);
  name_block_at(number, feed_.faulty_x());
  end_ahead_of_fault();
}

void SmoothRun::name_block_at(std::int64_t number, double x) noexcept {
  const auto name = [&](std::uint64_t sequence, std::uint32_t line) {
    faulty_block_.sequence = sequence;
    faulty_block_.line = line;
  };
  for (std::int64_t i = number; i < spans_.end_index(); ++i) {
    const JointSpan& span = spans_[i];
    for (std::uint32_t n = 0; n < span.marks.count; ++n) {
      const BlockMark& mark = span.marks.at[n];
      if (i == number && mark.s < x) continue;
      return name(span.band.sequence + mark.ahead, mark.line);
    }
  }
  // A long block: its end lies on no span yet that the feed was given.
  if (ends_.begin_index() < ends_.end_index()) {
    const BlockEnd& end = ends_[ends_.begin_index()];
    name(end.sequence, end.line);
  } else if (const auto block = band_.block_behind()) {
    name(block->sequence, block->line);
  }
}

void SmoothRun::end_ahead_of_fault() noexcept {
  supply_ = Supply::kEnded;
  note_relaxed_axis(nullptr);
  // What is published may be run to its rests.
  std::int64_t first_free_cell = 0;
  for (const OpenWindow& open : open_) first_free_cell = std::max(first_free_cell, open.rest_cell);
  for (std::int64_t i = spans_.end_index() - 1; i >= spans_.begin_index(); --i) {
    const JointSpan& span = spans_[i];
    for (std::uint32_t n = span.marks.count; n > 0; --n) {
      const BlockMark& mark = span.marks.at[n - 1];
      if (span.band.sequence + mark.ahead >= faulty_block_.sequence) continue;
      return feed_.end_at(span, static_cast<std::uint64_t>(i), mark.s, first_free_cell);
    }
  }
  feed_.end_at({}, 0, 0, first_free_cell);  // nothing lies ahead of it
}

/// On the pole the redundant joint is held where it came from: it is followed there, as the cycle
/// does, which rests where the last of its places led. A span that leaves reach ahead of its end,
/// where a run that is refused rests, has the last joints that there are.
JointVector SmoothRun::joints_on(const PathPiece& piece, double end) const noexcept {
  JointVector joints = piece.joints_begin;
  for (double left = 0.1; left > 1e-7; left *= 0.1) {
    const auto near_end = joints_at(model_, piece, (1 - left) * end, joints);
    if (near_end.status != SolveStatus::kUnreachable) joints = near_end.q;
  }
  const auto at_end = joints_at(model_, piece, end, joints);
  return at_end.status == SolveStatus::kUnreachable ? joints : at_end.q;
}

JointVector SmoothRun::joints_at_rest() const noexcept {
  const CellGrid& grid = feed_.grid();
  if (grid.last() == grid.first()) return span_joints_;
  const FeedCell& last = grid[grid.last() - 1];
  const auto number = static_cast<std::int64_t>(last.span);
  if (number >= begins_.end_index()) return span_joints_;
  PathPiece piece = make_spline(spans_[number]);
  piece.tool_length_mm = start_.tool_length_mm;
  piece.joints_begin = begins_[number];
  return joints_on(piece, std::min(last.x + last.h, piece.length));
}

/// Names the block ahead of which the machine comes to rest: of the first span that is held back
/// beside the pole, or else of the last that was handed on.
void SmoothRun::fail_ahead() noexcept {
  const BandSpan none;
  const BandSpan* at = corridor_.first_held();
  if (at == nullptr) at = spans_.end_index() > 0 ? &spans_.back().band : &none;
  const PathFault fault = band_.has_failed()
                              ? PathFault{PathFault::Kind::kTooLong, -1, 0}
                              : PathFault{PathFault::Kind::kBranch, redundant_joint(model_), 0};
  fail(fault, at->sequence, at->line);
}

}  // namespace meridian
