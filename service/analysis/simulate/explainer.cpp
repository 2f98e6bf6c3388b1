// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/explainer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/time_law.hpp"

namespace meridian::simulate {
namespace {

constexpr double kFullRate = 0.999;  // below it the operator holds back
constexpr double kNothing_s = 1e-9;

[[nodiscard]] std::size_t at(Cause cause) { return static_cast<std::size_t>(cause); }

template <std::size_t N>
[[nodiscard]] std::size_t find_largest(const std::array<float, N>& values) {
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

/// Index of what cost most; where nothing to speak of was lost, of what held longest.
template <std::size_t N>
[[nodiscard]] std::size_t find_main(const std::array<float, N>& lost,
                                    const std::array<float, N>& time, double whole_s) {
  const std::size_t largest = find_largest(lost);
  return lost[largest] > 0.01 * whole_s ? largest : find_largest(time);
}

}  // namespace

LimitId ExplainedBlock::main_limit() const noexcept {
  return static_cast<LimitId>(find_main(lost_by_limit, by_limit, time_s));
}

Cause ExplainedBlock::main_cause() const noexcept {
  return static_cast<Cause>(find_main(lost_by_cause, by_cause, time_s));
}

Explainer::Explainer(const MachineModel& model, TakeBlock take_block, TakeCycle take_cycle,
                     TakeCause take_cause)
    : model_(model),
      limits_(model),
      take_block_(std::move(take_block)),
      take_cycle_(std::move(take_cycle)),
      take_cause_(std::move(take_cause)),
      period_s_(static_cast<double>(model.cycle_ns) * 1e-9) {}

void Explainer::add_block(const ClBlock& block, double programmed_feed, double tip_length_mm,
                          double path_length_mm) {
  Open open;
  open.block.sequence = block.sequence;
  open.block.line = block.line;
  open.block.kind = block.kind;
  open.block.length_mm = tip_length_mm;
  open.path_begin_mm = planned_mm_;
  planned_mm_ += path_length_mm;
  open.path_end_mm = planned_mm_;
  if (block.kind == BlockKind::kCut && block.feed_meaning == FeedMeaning::kTip) {
    open.block.is_above_machine_feed = programmed_feed > block.feed;
    open.block.programmed_mm_per_s = programmed_feed;
  } else if (block.kind == BlockKind::kCut && block.feed_meaning == FeedMeaning::kInverseTime) {
    open.share_per_s = programmed_feed;
    open.block.programmed_mm_per_s = tip_length_mm * programmed_feed;
  }
  open_.push_back(open);
}

Explainer::Open* Explainer::find(std::uint64_t sequence) {
  if (open_.empty() || sequence < open_.front().block.sequence) return nullptr;
  const std::uint64_t n = sequence - open_.front().block.sequence;
  return n < open_.size() ? &open_[n] : nullptr;
}

void Explainer::add_relaxed_axis(std::uint64_t first, std::uint64_t last, double deviation_rad) {
  for (std::uint64_t n = first; n <= last; ++n) {
    if (Open* const open = find(n)) {
      open->block.relaxed_rad = std::max(open->block.relaxed_rad, deviation_rad);
    }
  }
}

void Explainer::add_cycle(const CycleRecord& record, const TimePiece* piece, const PathPiece* path,
                          double piece_time, double tool_length_mm) {
  const Vector3 tip = forward(model_, tool_length_mm, record.joints).tip;
  const double distance_mm = has_tip_ ? (tip - tip_).norm() : 0;
  tip_ = tip;
  has_tip_ = true;
  const bool is_moving = piece != nullptr && path != nullptr && piece->kind == TimeKind::kMove;
  LimitView view;
  std::optional<Cause> cause;
  std::uint64_t block = record.sequence;
  double path_position = path_position_;
  const bool sets_off = is_moving && piece->is_from_rest && piece->window != window_;
  if (piece != nullptr) window_ = piece->window;
  if (sets_off || !is_moving) {
    decide(Cause::kRest);
    speeds_up_from_ = Cause::kRest;
    is_braking_ = false;
  }
  if (is_moving) {
    const PathState p = state_at(*piece, std::min(piece_time, piece->duration));
    path_position = find_path_position(*path, p.s, p.ds * record.rate);
    if (path->kind == PathKind::kSpline)
      block = find_block(path_position, std::max(record.sequence, running_));
    if (path->motion == MotionKind::kRewind) block = std::max(block, running_);
    const Open* const open = find(block);
    view = limits_.look(*path, *piece, piece_time, record.joints,
                        open != nullptr ? find_feed_share(*open, p.ds) : 0);
    if (view.limit == kFeedLimit && open != nullptr && open->block.is_above_machine_feed) {
      view.limit = kMachineFeedLimit;
    }
    cause = cause_of(view, record);
    if (path->motion == MotionKind::kRewind) {
      decide(Cause::kRest);
      speeds_up_from_ = Cause::kRest;
      is_braking_ = false;
      cause = Cause::kRewind;
    }
  } else {
    cause = Cause::kWaiting;
    is_on_span_ = false;
  }
  share_out(block, path_position, view, view.speed * std::max(record.rate, 0.0), distance_mm,
            cause);
  if (take_cycle_) {
    const Open* const open = find(block);
    take_cycle_({period_s_, distance_mm, distance_mm / period_s_,
                 open != nullptr ? open->block.programmed_mm_per_s : 0, view.limit, tool_length_mm,
                 cause});
  }
  ++explanation_.cycles;
  explanation_.time_s = period_s_ * static_cast<double>(explanation_.cycles);
  running_ = block;
  path_position_ = path_position;
  close_blocks(running_);
}

std::optional<Cause> Explainer::cause_of(const LimitView& view, const CycleRecord& record) {
  if (record.rate < kFullRate) return Cause::kOverride;
  if (view.is_ramp && view.change < 0) {
    bends_ahead_ = (is_braking_ && bends_ahead_) || view.cause == Cause::kBend;
    is_braking_ = true;
    return std::nullopt;
  }
  if (view.is_ramp && view.change > 0) {
    if (is_braking_) {
      speeds_up_from_ = bends_ahead_ ? Cause::kBend : view.cause;
      decide(speeds_up_from_);
      is_braking_ = false;
    }
    return speeds_up_from_;
  }
  speeds_up_from_ = view.cause == Cause::kFeed ? Cause::kPath : view.cause;
  decide(speeds_up_from_);
  is_braking_ = false;
  return view.cause;
}

double Explainer::find_feed_share(const Open& open, double speed) {
  const double length = open.path_end_mm - open.path_begin_mm;
  return open.share_per_s > 0 && length > 0 ? speed / (length * open.share_per_s) : 0;
}

double Explainer::find_path_position(const PathPiece& path, double s, double speed) {
  if (path.motion == MotionKind::kRewind) return path_position_;  // off the path, and back to it
  const Open* const open = find(path.sequence);  // may be over: a span reaches over many
  if (path.kind != PathKind::kSpline) {
    is_on_span_ = false;
    return open != nullptr ? open->path_end_mm : path_position_;
  }
  if (!is_on_span_) {
    span_begin_ = open != nullptr ? open->path_begin_mm : path_position_;
  } else if (path.index == span_index_ + 1) {
    span_begin_ += span_length_;
  } else if (path.index != span_index_) {  // several in one cycle
    span_begin_ = path_position_ + speed * period_s_ - s;
  }
  if (open != nullptr) {
    span_begin_ = std::clamp(span_begin_, open->path_begin_mm, open->path_end_mm);
  }
  is_on_span_ = true;
  span_index_ = path.index;
  span_length_ = path.length;
  return span_begin_ + s;
}

std::uint64_t Explainer::find_block(double path_position, std::uint64_t from) {
  while (true) {
    const Open* const next = find(from + 1);
    const Open* const here = find(from);
    if (next == nullptr || here == nullptr || !is_motion(next->block.kind)) return from;
    if (path_position <= here->path_end_mm) return from;
    ++from;
  }
}

void Explainer::give(Open& open, double time_s, const LimitView& view, double speed,
                     double feed_mm_per_s, std::optional<Cause> cause) {
  const bool is_first = !(open.block.time_s > 0);
  open.block.distance_mm += feed_mm_per_s * time_s;
  open.block.min_mm_per_s =
      is_first ? feed_mm_per_s : std::min(open.block.min_mm_per_s, feed_mm_per_s);
  const double programmed = open.block.programmed_mm_per_s;
  const double share = open.share_per_s > 0 ? find_feed_share(open, speed)
                       : programmed > 0     ? feed_mm_per_s / programmed
                                            : 0;
  account(open, view.limit, cause, time_s, share);
}

void Explainer::share_out(std::uint64_t last, double path_position, const LimitView& view,
                          double speed, double distance_mm, std::optional<Cause> cause) {
  const double feed = distance_mm / period_s_, passed = path_position - path_position_;
  double left_s = period_s_;
  for (std::uint64_t n = running_; is_on_span_ && passed > 0 && n < last; ++n) {
    Open* const open = find(n);
    if (open == nullptr) continue;
    const double part = open->path_end_mm - std::max(path_position_, open->path_begin_mm);
    const double time_s = std::clamp(period_s_ * part / passed, 0.0, left_s);
    if (time_s > kNothing_s) give(*open, time_s, view, speed, feed, cause);
    left_s -= time_s;
  }
  if (Open* const open = find(last)) give(*open, left_s, view, speed, feed, cause);
}

void Explainer::account(Open& open, LimitId limit, std::optional<Cause> cause, double time_s,
                        double feed_share) {
  const bool is_cut = open.block.kind == BlockKind::kCut;
  const double lost_s = is_cut ? time_s * std::max(0.0, 1 - feed_share) : 0;
  open.block.time_s += time_s;
  open.block.lost_s += lost_s;
  explanation_.lost_s += lost_s;
  if (cause) {
    book(open, limit, *cause, time_s, lost_s);
    return;
  }
  if (undecided_.size() == kMaxUndecided) decide(Cause::kPath);
  undecided_.push_back({open.block.sequence, limit, time_s, lost_s});
}

void Explainer::decide(Cause cause) {
  for (const Undecided& part : undecided_) {
    if (Open* const open = find(part.sequence)) {
      book(*open, part.limit, cause, part.time_s, part.lost_s);
    }
  }
  undecided_.clear();
  if (take_cause_) take_cause_(cause);
}

void Explainer::book(Open& open, LimitId limit, Cause cause, double time_s, double lost_s) {
  Explanation::Share& share = explanation_.shares[limit][at(cause)];
  share.time_s += time_s;
  share.lost_s += lost_s;
  open.block.by_limit[limit] += static_cast<float>(time_s);
  open.block.by_cause[at(cause)] += static_cast<float>(time_s);
  open.block.lost_by_limit[limit] += static_cast<float>(lost_s);
  open.block.lost_by_cause[at(cause)] += static_cast<float>(lost_s);
}

void Explainer::close_blocks(std::uint64_t running) {
  while (!open_.empty() && open_.front().block.sequence < running &&
         (undecided_.empty() || undecided_.front().sequence > open_.front().block.sequence)) {
    close_front();
  }
}

void Explainer::close_front() {
  const ExplainedBlock& block = open_.front().block;
  ++explanation_.blocks;
  add_to_stretch(block);
  if (take_block_) take_block_(block);
  open_.pop_front();
}

void Explainer::finish() {
  decide(Cause::kRest);
  while (!open_.empty()) close_front();
  close_stretch();
}

void Explainer::add_to_stretch(const ExplainedBlock& block) {
  if (!(block.time_s > 0)) return;
  const LimitId limit = block.main_limit();
  const Cause cause = block.main_cause();
  if (stretch_.blocks > 0 && (limit != stretch_.limit || cause != stretch_.cause)) close_stretch();
  if (stretch_.blocks == 0) {
    stretch_.first_line = block.line;
    stretch_.limit = limit;
    stretch_.cause = cause;
    stretch_.min_mm_per_s = block.min_mm_per_s;
  }
  stretch_.last_line = block.line;
  ++stretch_.blocks;
  stretch_.time_s += block.time_s;
  stretch_.lost_s += block.lost_s;
  stretch_.distance_mm += block.distance_mm;
  stretch_.programmed_mm_per_s = std::max(stretch_.programmed_mm_per_s, block.programmed_mm_per_s);
  stretch_.min_mm_per_s = std::min(stretch_.min_mm_per_s, block.min_mm_per_s);
}

void Explainer::close_stretch() {
  auto& worst = explanation_.worst;
  if (stretch_.blocks > 0 && stretch_.lost_s > 0) {
    const auto path_position = std::find_if(
        worst.begin(), worst.end(),
        [this](const ExplainedStretch& other) { return stretch_.lost_s > other.lost_s; });
    worst.insert(path_position, stretch_);
    if (worst.size() > Explanation::kMaxStretches) worst.pop_back();
  }
  stretch_ = {};
}

}  // namespace meridian::simulate
