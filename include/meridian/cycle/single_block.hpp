// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/stop/on_path.hpp"
#include "meridian/planner/motion_ahead.hpp"

/// Single block: the program comes to rest at the end of each block. Where the plan runs on through
/// it the rate of plan time goes down to zero there, for which every plan leaves room.
///
///     rate 1 ┤───────.                 D: plan time from here to rest, braking as hard as
///            │        '·.              may be; R: plan time to the end of a block.
///          0 ┼────────────'·█──▶ R     Braking begins at the very instant at which D = R.
///
/// D is the least that there is, so R - D never grows: the nearest end with R >= D is the next that
/// can be reached, and none is left out once the machine has rested. It is sought anew in every
/// cycle until the rate brakes for it. docs/decisions/0011-single-block.md. RT: cycle. Proof:
/// tests/property/cycle/single_block_test.cpp.
namespace meridian {

/// Single block is offered up to this override ramp: braking takes half of it in plan time, which
/// must be well in sight (docs/decisions/0011-single-block.md).
inline constexpr double kMaxStepRamp_s = 2;
/// Places of the port that are gone over in one look, but for the tail that it ends in or behind.
/// Where they last less than it takes to come to rest the rate goes down until they do; of dense
/// smooth plans up to 1900 last as long as it takes at most.
inline constexpr std::size_t kMaxPathsAhead = 3072;
/// Nearer to a rest of the plan than this a block ends there.
inline constexpr double kSameEnd_mm = 5e-7;
/// Far above the rounding of sums of plan time.
inline constexpr double kMin_s = 1e-12;

/// How far the end of a block is away on the plan ahead.
struct BlockEndAhead {
  bool is_found = false;
  bool is_limited = false;          ///< not found among the most places that are gone over
  double plan_time = 0;             ///< from here; not found: to where it was sought
  int pieces = 0;                   ///< ends of time pieces in between
  double time = 0;                  ///< on its time piece
  std::uint64_t sequence = 0;       ///< of the block
  std::uint32_t line = 0;           ///< its source line
  const TimePiece* tail = nullptr;  ///< not entered: a window may come that goes on in its place
  double tail_time = 0;             ///< plan time to it: nothing is known of what lies behind
};

/// Looks for the end of block `next_block` or a later one on the motion `piece`, which begins in
/// `begin` s of plan time and is followed by `next`, no nearer than `min`.
[[nodiscard]] inline bool find_end_on(MotionReader& reader, std::uint64_t next_block,
                                      const TimePiece& piece, const TimePiece* next, double begin,
                                      double min, BlockEndAhead& out) noexcept {
  const PathPiece* path = reader.path_of(piece);
  if (path == nullptr) return false;
  const bool ends_path = next == nullptr || next->path_index != piece.path_index;
  const double rest = next == nullptr ? state_at(piece, piece.duration).s - kSameEnd_mm : 0;
  for (std::uint32_t i = 0; i < path->marks.count; ++i) {
    const BlockMark& mark = path->marks.at[i];
    if (!ends_path && mark.s >= next->s0) return false;
    if (next == nullptr && mark.s > rest) return false;
    const std::uint64_t sequence = path->sequence + mark.ahead;
    if (mark.s < piece.s0 || sequence < next_block) continue;
    const double time = time_at(piece, mark.s, 0.5 * piece.duration);
    if (begin + time < min) continue;
    out.is_found = true;
    out.plan_time = begin + time;
    out.time = time;
    out.sequence = sequence;
    out.line = mark.line;
    return true;
  }
  return false;
}

/// The nearest end of a block that is at least `min` of plan time away and that the plan runs on
/// through; what is farther than `max` does not matter. Only while a motion is in force.
[[nodiscard, gnu::noinline]] inline BlockEndAhead find_block_end(const Cycle& c, double min,
                                                                 double max) noexcept {
  BlockEndAhead out;
  MotionAhead ahead(c.reader);
  const TimePiece* piece = c.reader.piece();
  double begin = -c.state.piece_time;
  while (piece != nullptr && begin <= max) {
    if (ahead.slots() >= kMaxPathsAhead) {
      out.is_limited = true;
      break;
    }
    if (ahead.tail() != nullptr && out.tail == nullptr) {
      out.tail = ahead.tail();
      out.tail_time = begin;
    }
    const TimePiece* next = ahead.next();
    const double end = begin + piece->duration;
    if (end >= min &&
        find_end_on(c.reader, c.state.single_block.next_block, *piece, next, begin, min, out))
      return out;
    begin = end;
    piece = next;
    ++out.pieces;
  }
  out.plan_time = begin;
  return out;
}

/// The rate at which the plan may leave its rest: no more than `wanted`, and one period of it and
/// the way to rest are over where the first block ends, or what is known of the plan.
[[nodiscard]] inline double rate_from_rest(const Cycle& c, double wanted) noexcept {
  constexpr double kRounding = 1e-9;
  if (!c.state.single_block.is_on) return wanted;
  RateFilter full = c.state.rate;
  full.reset(wanted);
  const BlockEndAhead end = find_block_end(c, 0, full.plan_time_to_rest() + 2 * c.dt);
  const bool has_tail = end.tail != nullptr;
  if (!end.is_found && !end.is_limited && !has_tail) return wanted;
  const double sight = has_tail ? end.tail_time : end.plan_time;
  const double period = std::min(wanted, full.rate_with_rest_in(sight)) * c.dt;
  return std::min(wanted, (1 - kRounding) * full.rate_with_rest_in(sight - period));
}

/// The rate goes down from now on.
inline void begin_braking(Cycle& c, const BlockEndAhead& end) noexcept {
  SingleBlock& single = c.state.single_block;
  c.state.rate.aim(0);
  single.phase = SingleBlock::Phase::kBraking;
  single.pieces = end.pieces;
  single.time = end.time;
  single.sequence = end.sequence;
  single.line = end.line;
  if (end.tail != nullptr) c.reader.keep_tail(*end.tail);
}

/// One period of the rate, which begins to brake in it where it has to. Returns the plan time that
/// passes. What lies behind a tail is not known: where the rate could not come to rest before it
/// any more, the tail is run, whatever comes.
[[nodiscard, gnu::noinline]] inline double advance_to_block_end(Cycle& c) noexcept {
  RateFilter& rate = c.state.rate;
  const double min = rate.plan_time_to_rest();
  RateFilter next = rate;
  const double passed = next.advance(c.dt);
  const double needed = passed + next.plan_time_to_rest() + kMin_s;
  const BlockEndAhead end = find_block_end(c, min, needed + c.dt);
  if (end.tail != nullptr && end.tail_time < needed) c.reader.keep_tail(*end.tail);
  if (!end.is_found && end.is_limited && end.plan_time < needed) {
    rate.aim(0);
    return rate.advance(c.dt);
  }
  if (!end.is_found || end.plan_time >= needed) {
    rate = next;
    return passed;
  }
  double low = 0, high = c.dt;
  for (int n = 0; n < 50; ++n) {
    const double middle = 0.5 * (low + high);
    next = rate;
    const double before = next.advance(middle);
    (before + next.plan_time_to_rest() <= end.plan_time ? low : high) = middle;
  }
  const double before = rate.advance(low);
  begin_braking(c, end);
  return before + rate.advance(c.dt - low);
}

/// At rest at the end of block `sequence`: until the operator sends it on.
inline void rest_after_block(Cycle& c, std::uint64_t sequence, std::uint32_t line) noexcept {
  c.state.single_block.phase = SingleBlock::Phase::kResting;
  c.state.single_block.next_block = sequence + 1;
  c.state.rate.reset(0);
  c.state.sequence = sequence;
  c.state.line = line;
  report_block_done(c);
  enter(c, State::kStepping);
}

/// Where the plan rests at the end of the motion in force: rests there too if a block ends there.
[[nodiscard]] inline bool rests_after_motion(Cycle& c, const PathState& end) noexcept {
  const PathPiece& path = *c.reader.path();
  if (end.ds > kRest_mm_per_s) return false;
  for (std::uint32_t i = 0; i < path.marks.count; ++i) {
    const BlockMark& mark = path.marks.at[i];
    const std::uint64_t sequence = path.sequence + mark.ahead;
    const bool is_here = std::abs(mark.s - end.s) <= kSameEnd_mm;
    if (!is_here || sequence < c.state.single_block.next_block) continue;
    c.state.piece_time = c.reader.piece()->duration;
    rest_after_block(c, sequence, mark.line);
    return true;
  }
  return false;
}

/// Leaves the rest that a dwell or an action was, where the operator does not want to be asked.
inline void leave_barrier(Cycle& c) noexcept {
  const TimePiece& piece = *c.reader.piece();
  if (c.state.single_block.is_on) return rest_after_block(c, piece.sequence, piece.line);
  next_piece(c);
}

/// Goes over the pieces that plan time has passed, up to the end of the block that the rate brakes
/// for, and rests there when it is zero.
inline void follow_braking_rate(Cycle& c) noexcept {
  SingleBlock& single = c.state.single_block;
  const bool is_over = c.state.rate.is_settled();
  while (single.pieces > 0 && (is_over || c.state.piece_time >= c.reader.piece()->duration)) {
    const double beyond = c.state.piece_time - c.reader.piece()->duration;
    if (!next_piece(c) || !is_on_move(c)) {
      single.leave_brake();
      return;
    }
    c.state.piece_time = std::max(0.0, beyond);
    --single.pieces;
  }
  if (single.pieces > 0) return;
  c.state.piece_time = is_over ? single.time : std::min(c.state.piece_time, single.time);
  if (is_over && single.is_on) return rest_after_block(c, single.sequence, single.line);
  if (is_over) single.leave_brake();
}

/// After a rest in mid-motion: reports the block that begins, if its end is in sight.
inline void begin_next_block(Cycle& c) noexcept {
  for (std::size_t n = 0; const PathPiece* path = c.reader.path_ahead(n); ++n) {
    if (n == static_cast<std::size_t>(kMaxPieces)) return;
    for (std::uint32_t i = 0; i < path->marks.count; ++i) {
      const std::uint64_t sequence = path->sequence + path->marks.at[i].ahead;
      if (sequence < c.state.single_block.next_block) continue;
      c.state.has_block = true;
      c.state.sequence = sequence;
      c.state.line = path->marks.at[i].line;
      emit(c, EventCode::kBlockStarted, sequence, c.state.line);
      return;
    }
  }
}

/// Whether something is there to go on with after the block that the machine rests behind.
[[nodiscard]] inline bool leave_block(Cycle& c) noexcept {
  const TimePiece* piece = c.reader.piece();
  const bool is_inside = is_on_move(c) && c.state.piece_time < piece->duration;
  if (!is_inside && !next_piece(c)) return false;
  c.state.single_block.phase = SingleBlock::Phase::kRunning;
  if (is_inside) begin_next_block(c);
  return true;
}

}  // namespace meridian
