// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/geometry/jet.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/time_law.hpp"

/// The place on the path: from path length to joints, from piece to piece. RT: cycle.
namespace meridian {

/// A period goes over at most that many time pieces. Those beside rests may be shorter than a
/// period, hardly any elsewhere, so this is a bound and not a rule.
inline constexpr int kMaxPieces = 64;

/// A plan that is no faster rests: rounding of its end is 1e-12 of its speed.
inline constexpr double kRest_mm_per_s = 1e-6;

/// Whether the piece in force is a motion.
[[nodiscard]] inline bool is_on_move(const Cycle& c) noexcept {
  const TimePiece* piece = c.reader.piece();
  return piece != nullptr && piece->kind == TimeKind::kMove;
}

/// Whether the plan rests just here, so that its rate may be anything.
[[nodiscard]] inline bool is_plan_at_rest(const Cycle& c) noexcept {
  return !is_on_move(c) || (c.state.piece_time == 0 && begins_at_rest(*c.reader.piece()));
}

/// Puts the joints at path length `s` of the path piece in force, moving with `speed` along it.
/// False, and the joints unchanged, if no joints are there.
[[nodiscard]] inline bool put_on_path(Cycle& c, double s, double speed) noexcept {
  const PathPiece& path = *c.reader.path();
  const auto solution =
      joints_at(c.machine, path, Jet<1>::variable(std::clamp(s, 0.0, path.length)), c.state.joints);
  if (solution.status == SolveStatus::kUnreachable) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.machine.joint_count); ++i) {
    c.state.joints[i] = value_of(solution.q[i]);
    c.state.velocity[i] = speed == 0 ? 0 : solution.q[i].derivative(1) * speed;
  }
  c.state.motion = path.motion;
  return true;
}

/// No motion: the joints stay where they are.
inline void rest(CycleState& state) noexcept {
  state.velocity = {};
  state.on_path.ds = state.on_path.dds = state.on_path.ddds = 0;
}

/// Reports which block ended and which began, if the piece in force belongs to another one.
inline void report_block(Cycle& c) noexcept {
  const TimePiece& piece = *c.reader.piece();
  if (c.state.has_block && c.state.sequence == piece.sequence) return;
  if (piece.sequence < c.state.single_block.next_block) return;  // the path piece began in it
  if (c.state.has_block) emit(c, EventCode::kBlockDone, c.state.sequence, c.state.line);
  c.state.has_block = piece.kind != TimeKind::kEnd;
  c.state.sequence = piece.sequence;
  c.state.line = piece.line;
  if (c.state.has_block) emit(c, EventCode::kBlockStarted, piece.sequence, piece.line);
}

/// Reports that the block in force is done; nothing happens if there is none.
inline void report_block_done(Cycle& c) noexcept {
  if (!c.state.has_block) return;
  c.state.has_block = false;
  emit(c, EventCode::kBlockDone, c.state.sequence, c.state.line);
}

/// Leaves the piece in force and goes to the one that follows. False if none is there: the plan
/// rests at the end of the last one.
inline bool next_piece(Cycle& c) noexcept {
  if (c.reader.piece() != nullptr) c.state.program_time += c.reader.piece()->duration;
  c.state.piece_time = 0;
  c.state.barrier_time = 0;
  c.state.action = ActionState::kNotReported;
  if (c.reader.advance() == nullptr) return false;
  report_block(c);
  return true;
}

/// Returns the time at which the motion of `piece` is at path length `s`; 0 or the piece's duration
/// where it never is. ṡ >= 0 makes it unique but for rests. Newton inside a bracket, from `guess`.
[[nodiscard]] inline double time_at(const TimePiece& piece, double s, double guess) noexcept {
  double low = 0, high = piece.duration;
  if (!(s > piece.s0)) return 0;
  if (s >= state_at(piece, high).s) return high;
  double t = std::clamp(guess, low, high);
  for (int n = 0; n < 64 && high - low > 0; ++n) {
    const PathState p = state_at(piece, t);
    (p.s < s ? low : high) = t;
    const double newton = t + (s - p.s) / p.ds;
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (next == t || p.s == s) break;
    t = next;
  }
  return t;
}

/// Puts the joints at the end of the piece in force if the plan rests there: where nothing follows,
/// its path is gone once the next piece was asked for. False if no joints are there.
[[nodiscard]] inline bool settle_at_end(Cycle& c, const PathState& end) noexcept {
  return end.ds > kRest_mm_per_s || put_on_path(c, end.s, 0);
}

/// Goes forward from piece to piece until the one in force holds path length `s` of the path piece
/// in force; path pieces left behind are subtracted from `s` and added to `passed`. False where the
/// plan rests before: `s` is then the end of the path that was there, and the joints are put there.
[[nodiscard]] inline bool walk_to(Cycle& c, double& s, double& passed) noexcept {
  for (int n = 0; n < kMaxPieces && is_on_move(c); ++n) {
    const TimePiece& piece = *c.reader.piece();
    const PathPiece& path = *c.reader.path();
    const PathState end = state_at(piece, piece.duration);
    if (s <= end.s) return true;
    const std::uint64_t index = path.index;
    const double length = path.length;
    if (!settle_at_end(c, end)) return false;
    if (!next_piece(c) || !is_on_move(c)) {
      s = end.s;
      return false;
    }
    if (c.reader.path()->index != index) {
      s -= length;
      passed += length;
    }
  }
  return is_on_move(c);
}

}  // namespace meridian
