// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/smooth_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"

namespace meridian {
namespace {

/// More spans than the feed keeps cells: every cell lies in one span.
constexpr std::size_t kSpans = 2048;
constexpr std::size_t kMaxRelaxedAxes = 256;  // that wait to be taken; the oldest go
constexpr std::size_t kBlockEnds = 8192;
constexpr std::size_t kTogether = 2;  // pieces outside of tails that share an authority to stop
constexpr double kSameCut_mm = 1e-9;  // of u, where spans were cut

/// Least time that a span takes at its programmed feed.
double min_time(const BandSpan& span) noexcept {
  const double chord = (pose_on(span.c, span.length).tip - pose_on(span.c, 0.0).tip).norm();
  return std::max(chord / span.feed_mm_per_s, span.length / span.u_speed_mm_per_s);
}

}  // namespace

SmoothRun::SmoothRun(const MachineModel& model, FeedRaise& raise, PoleLookAhead* look_ahead)
    : model_(model),
      raise_(raise),
      corridor_(model, look_ahead),
      passes_(model),
      feed_(model, feed_settings(model)),
      stop_margin_(model),
      travel_(model),
      spans_(kSpans),
      ends_(kBlockEnds),
      begins_(kSpans),
      relaxed_axes_(kMaxRelaxedAxes) {}

void SmoothRun::begin(const RunStart& start, const BandTolerance& tolerance,
                      double pole_tolerance_rad) noexcept {
  start_ = start;
  band_.begin(start.pose, tolerance);
  corridor_.begin({start.joints, start.branch, start.tool_length_mm, start.pose.axis,
                   pole_tolerance_rad, start.is_on_pole});
  passes_.begin({start.joints, start.branch, start.tool_length_mm, start.programmed,
                 pole_tolerance_rad, tolerance.tip_mm});
  begin_feed(start.branch);
  ends_.clear();
  may_rewind_ = model_.rewind_policy == RewindPolicy::kRetract && redundant_joint(model_) >= 0;
  relaxed_axis_.reset();
  is_band_finished_ = false;
  fault_ = {};
  faulty_block_ = {};
}

void SmoothRun::begin_feed(int branch) noexcept {
  feed_.begin(start_.joints, branch, start_.tool_length_mm);
  raise_.rest();
  spans_.clear();
  begins_.clear();
  staged_spans_ = 0;
  span_joints_ = start_.joints;
  travel_.begin(start_.joints, start_.tool_length_mm);
  window_ = rested_window_ = start_.window;
  open_.fill({});
  has_window_ = false;
  supply_ = Supply::kFlowing;
}

void SmoothRun::go_on(const RewindTarget& target, std::uint64_t path_index,
                      std::uint32_t window) noexcept {
  if (target.is_other_branch()) {
    held_.branch = target.branch;
    corridor_.change_branch(target.branch, travel_.end_from(target.joints, held_));
  } else {
    const double by = target.turns * kTurn_rad;
    corridor_.wind(by, travel_.end_of(held_, by));
    for (double& value : held_.free) value += by;
  }
  start_.joints = target.joints;
  start_.path_index = path_index;
  start_.window = window;
  begin_feed(held_.branch);
  supply_ = Supply::kRewound;
}

bool SmoothRun::fits(const RewindTarget& target) const noexcept {
  if (!target.is_other_branch()) {
    const double by = target.turns * kTurn_rad;
    return travel_.fits(held_, by) && corridor_.fits_zone(by);
  }
  JointSpan span = held_;
  span.branch = target.branch;
  return corridor_.may_change_branch() && !held_.is_free_driven &&
         travel_.fits_from(target.joints, span);
}

void SmoothRun::take(const ClBlock& block) noexcept {
  if (band_.push(block)) return;
  fail({PathFault::Kind::kTooLong, -1, 0}, block.sequence, block.line);
  band_.finish();
}

void SmoothRun::fail(const PathFault& fault, std::uint64_t sequence, std::uint32_t line) noexcept {
  fault_ = fault;
  faulty_block_.sequence = sequence;
  faulty_block_.line = line;
  faulty_block_.joint = fault.joint;
  faulty_block_.value = fault.value;
}

SmoothRun::Status SmoothRun::publish(MotionWriter& writer) noexcept {
  for (;;) {
    const Status status = publish_window(writer);
    if (status != Status::kPublished) return status;
  }
}

SmoothRun::Status SmoothRun::publish_window(MotionWriter& writer) noexcept {
  for (;;) {
    follow_tail(writer);
    if (has_window_) {
      if (!write(writer)) return Status::kNoRoom;
      has_window_ = false;
      return Status::kPublished;
    }
    const Status status = prepare(writer.feed_override());
    if (has_window_) continue;
    const bool is_end =
        status == Status::kDone || status == Status::kRewind || status == Status::kFailed;
    return is_end && !is_end_certain(writer) ? Status::kNoRoom : status;
  }
}

/// Whether the cycle will come to the end of the run: no tail is left that it could enter instead.
bool SmoothRun::is_end_certain(const MotionWriter& writer) const noexcept {
  const bool has_one_window = window_ == rested_window_ + 1;
  if (window_ == rested_window_ || has_one_window) return true;
  const auto begun = writer.window_begun();
  return begun && begun->epoch == start_.epoch && begun->window + 1 == window_;
}

/// Plans the next window, from as many spans as it takes.
SmoothRun::Status SmoothRun::prepare(double feed_override) noexcept {
  for (;;) {
    has_window_ = feed_.try_plan();
    if (has_window_) return Status::kNoRoom;
    if (is_fault(feed_.fault())) {
      fail_on_span();
      continue;
    }
    const bool is_at_rewind = supply_ == Supply::kHeld;
    if (is_feed_finished() && feed_.is_done()) {
      if (has_fault()) {
        span_joints_ = joints_at_rest();
        return Status::kFailed;
      }
      return is_at_rewind ? Status::kRewind : Status::kDone;
    }
    if (is_at_rewind) return Status::kNoRoom;  // every cell is there: windows go on coming
    if (!feed_.has_room()) return Status::kNeedsBlocks;
    if (const JointSpan* span = supply_ == Supply::kRewound ? &held_ : next_span()) {
      if (!(span->band.length > 0)) continue;
      if (!take_span(*span, feed_override)) return Status::kFailed;
    } else if (band_.has_failed() || corridor_.has_failed()) {
      fail_ahead();
      end_ahead_of_fault();
    } else if (is_band_finished_ && !is_feed_finished() && !corridor_.needs_ahead()) {
      supply_ = Supply::kEnded;
      note_relaxed_axis(nullptr);
      (void)feed_.finish();
    } else {
      return Status::kNeedsBlocks;
    }
  }
}

bool SmoothRun::take_span(const JointSpan& span, double feed_override) noexcept {
  if (!may_rewind_ || follow(span)) {
    note_relaxed_axis(&span);
    push(span, feed_override);
    if (supply_ == Supply::kRewound) supply_ = Supply::kFlowing;
    return true;
  }
  if (supply_ == Supply::kRewound) {
    fail({PathFault::Kind::kTravel, rewind_at_.joint, rewind_at_.value}, span.band.sequence,
         span.band.line);
    return false;
  }
  held_ = span;
  supply_ = Supply::kHeld;
  (void)feed_.finish();
  return true;
}

void SmoothRun::push(const JointSpan& span, double feed_override) noexcept {
  const FeedFactors factors = raise_.next(span.band.sequence, feed_override, min_time(span.band));
  spans_.push(span);
  spans_.back().feed_factor = factors.label;
  mark_block_ends(spans_.back());
  JointSpan planned = span;
  if (factors.planned > 1) {
    BandSpan& band = planned.band;
    band.u_speed_mm_per_s *= factors.planned;
    band.turn_rad_per_s *= factors.planned;
    band.feed_mm_per_s *= factors.planned;
    limit_feed(band);
  }
  (void)feed_.push(planned);
}

void SmoothRun::limit_feed(BandSpan& span) const noexcept {
  const double max_feed = model_.max_feed_mm_per_s;
  if (max_feed > 0) span.feed_mm_per_s = std::min(span.feed_mm_per_s, max_feed);
}

void SmoothRun::note_block_ends() noexcept {
  for (std::uint32_t n = 0; const auto end = band_.next_block_end(); ++n) {
    if (n < BlockMarks::kMax) {
      ends_.push_over_oldest(*end);
    } else {
      ends_.back() = *end;
    }
  }
}

void SmoothRun::mark_block_ends(JointSpan& span) noexcept {
  const BandSpan& band = span.band;
  span.marks = {};
  for (std::int64_t i = ends_.begin_index(); i < ends_.end_index(); ++i) {
    const BlockEnd& end = ends_[i];
    if (end.u > band.u0 + band.length + kSameCut_mm) break;
    const auto ahead = static_cast<std::uint32_t>(end.sequence - band.sequence);
    span.marks.add({std::clamp(end.u - band.u0, 0.0, band.length), ahead, end.line});
    ends_.drop_before(i + 1);
  }
}

bool SmoothRun::follow(const JointSpan& span) noexcept {
  const auto outside = travel_.follow(span);
  if (outside) {
    rewind_at_ = {span.band.sequence, span.band.line, RejectCode::kTravelBetween, outside->joint,
                  outside->value};
  }
  return !outside;
}

void SmoothRun::note_relaxed_axis(const JointSpan* span) noexcept {
  if (span != nullptr && relaxed_axis_) {  // as far as the begin of a span that is exact again
    relaxed_axis_->last_sequence = span->band.sequence;
    relaxed_axis_->last_line = span->band.line;
  }
  const bool deviates = span != nullptr && span->axis_deviation_rad > 0;
  if (relaxed_axis_ && (!deviates || span->reason != relaxed_axis_->reason)) {
    relaxed_axes_.push_over_oldest(*relaxed_axis_);
    relaxed_axis_.reset();
  }
  if (!deviates) return;
  const BandSpan& band = span->band;
  if (!relaxed_axis_) {
    relaxed_axis_ =
        RelaxedAxis{band.sequence, band.sequence, band.line, band.line, 0, span->reason};
  }
  relaxed_axis_->deviation_rad = std::max(relaxed_axis_->deviation_rad, span->axis_deviation_rad);
}

const JointSpan* SmoothRun::next_span() noexcept {
  for (;;) {
    if (const JointSpan* span = passes_.next()) return span;
    if (const JointSpan* span = corridor_.next()) {
      passes_.push(*span);
      continue;
    }
    if (is_band_finished_ || corridor_.needs_ahead()) return nullptr;
    const BandSpan* band = band_.next();
    if (band != nullptr) note_block_ends();
    while (const auto mark = band_.next_axis()) {
      if (!(mark->u > 0)) continue;
      corridor_.mark(mark->u, to_vector(mark->axis));
      passes_.mark(*mark);
    }
    if (band != nullptr) {
      BandSpan limited = *band;
      limit_feed(limited);
      corridor_.push(limited);
    } else if (band_.is_done()) {
      is_band_finished_ = true;
      corridor_.finish();
      passes_.finish();
    } else {
      return nullptr;
    }
  }
}

/// The cycle came to a tail before the next window did: go on from the rest at its end.
void SmoothRun::follow_tail(MotionWriter& writer) noexcept {
  const auto tail = writer.tail_entered();
  if (!tail || tail->epoch != start_.epoch) return;
  for (OpenWindow& open : open_) {
    if (open.rest_cell < 0 || open.window != tail->window) continue;
    feed_.resume_from(open.rest_cell);
    writer.forget_ahead();
    rested_window_ = window_;
    open_.fill({});
    has_window_ = false;
    return;
  }
}

bool SmoothRun::write(MotionWriter& writer) noexcept {
  const FeedWindow& window = feed_.window();
  std::uint64_t until = staged_spans_;
  for (const auto& pieces : {window.committed, window.tail}) {
    for (const FeedPiece& piece : pieces) until = std::max(until, piece.span + 1);
  }
  if (!writer.has_room(until - staged_spans_, window.committed.size() + window.tail.size())) {
    return false;
  }
  bool is_written = stage_spans(writer, until);
  stop_margin_.begin(feed_.grid(), window.rest_cell);
  is_written &= stage_pieces(writer, window.committed, false);
  is_written &= stage_pieces(writer, window.tail, true);
  if (!is_written) {
    writer.discard();
    return false;
  }
  writer.publish();
  open_[window_ % open_.size()] = {window_, window.tail.empty() ? -1 : window.rest_cell};
  ++window_;
  return true;
}

bool SmoothRun::stage_spans(MotionWriter& writer, std::uint64_t until) noexcept {
  for (; staged_spans_ < until; ++staged_spans_) {
    const JointSpan& span = spans_[static_cast<std::int64_t>(staged_spans_)];
    PathPiece piece = make_spline(span);
    piece.index = start_.path_index + staged_spans_;
    piece.epoch = start_.epoch;
    piece.tool_length_mm = start_.tool_length_mm;
    piece.joints_begin = joints_at(model_, piece, 0.0, span_joints_).q;
    piece.joints_end = joints_on(piece, piece.length);
    begins_.push(piece.joints_begin);
    span_joints_ = piece.joints_end;
    if (!writer.stage(piece)) return false;
  }
  return true;
}

TimePiece SmoothRun::make_piece(const FeedPiece& piece, bool is_tail) const noexcept {
  const JointSpan& joint_span = spans_[static_cast<std::int64_t>(piece.span)];
  const BandSpan& span = joint_span.band;
  TimePiece time;
  time.kind = TimeKind::kMove;
  time.is_tail = is_tail;
  time.is_from_rest = feed_.window().is_from_rest;
  time.epoch = start_.epoch;
  time.window = window_;
  time.path_index = start_.path_index + piece.span;
  time.sequence = span.sequence;
  time.line = span.line;
  put_law(piece, time);
  time.feed_mm_per_s = std::isfinite(span.feed_mm_per_s) ? span.feed_mm_per_s : 0;
  time.feed_factor = joint_span.feed_factor;
  return time;
}

/// Neighbouring pieces share their authority to stop; more of them in tails, of which hardly any is
/// ever entered.
bool SmoothRun::stage_pieces(MotionWriter& writer, std::span<const FeedPiece> pieces,
                             bool is_tail) noexcept {
  const std::size_t together = is_tail ? StopStretch::kMaxParts : kTogether;
  std::array<TimePiece, StopStretch::kMaxParts> times;
  bool is_staged = true;
  while (!pieces.empty()) {
    const auto some = pieces.first(std::min(together, pieces.size()));
    for (std::size_t n = 0; n < some.size(); ++n) times[n] = make_piece(some[n], is_tail);
    stop_margin_.grant(some, {times.data(), some.size()});
    for (std::size_t n = 0; n < some.size(); ++n) is_staged &= writer.stage(times[n]);
    pieces = pieces.subspan(some.size());
  }
  return is_staged;
}

}  // namespace meridian
