// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

namespace meridian {

inline constexpr double kAnyVelocity = std::numeric_limits<double>::infinity();

enum class TimeKind : std::uint8_t {
  kMove,          ///< s(t) on the path piece `path_index`
  kDwell,         ///< rest for `duration`
  kAction,        ///< rest until the action of block `sequence` is done
  kStop,          ///< rest, Held, until the operator resumes
  kOptionalStop,  ///< as kStop where the operator asked for it
  kEnd            ///< end of the program
};

/// When: a stretch of plan time on one path piece. The law is the linear ODE s''' = j + k s' with
/// constant j and k,
///
///     s(t) = s0 + v S(t) + a C(t) + j D(t),   z = k t²
///     S = t (1 + z/6 + z²/120 + ...),  C = t² (1/2 + z/24 + ...),  D = t³ (1/6 + z/120 + ...)
///
/// which is constant jerk for k = 0 and the exact motion of ṡ² quadratic in s for j = 0
/// (docs/motion.md). Windows: a window is published whole; its pieces marked `is_tail` bring the
/// plan to rest, and the cycle skips them if the next window is there in time. Every published plan
/// ends at rest. Trivially copyable: travels from the planner to the cycle in a ring.
struct TimePiece {
  TimeKind kind = TimeKind::kMove;
  bool is_tail = false;       ///< part of the window's stop, skipped if a later window continues
  bool is_from_rest = false;  ///< the window starts at rest: it may follow a tail that was run
  std::uint16_t epoch = 0;    ///< pieces of an old epoch are dropped
  std::uint32_t window = 0;   ///< counts windows of an epoch from 0
  std::uint64_t path_index = 0;
  std::uint64_t sequence = 0;   ///< CL block
  std::uint32_t line = 0;       ///< its source line
  double duration = 0;          ///< s of plan time
  double s0 = 0, v = 0, a = 0;  ///< state at t = 0: mm, mm/s, mm/s²
  double j = 0;                 ///< mm/s³
  double k = 0;                 ///< 1/s²
  double feed_mm_per_s = 0;     ///< tip feed that bounds it, 0 for rapid
  /// The tip is nowhere on the piece faster than the programmed feed times this, at least 1: plan
  /// time runs at no more than the feed override over it (docs/motion.md, section 9).
  double feed_factor = 1;
  /// Authority to stop: every StopLaw from here to the next rest with ṡ no faster than planned,
  /// |s̈| <= stop_accel and |s⃛| <= stop_jerk keeps every joint inside its limits (fault_*: its
  /// FaultStop limits).
  double stop_accel = 0, stop_jerk = 0;
  double fault_accel = 0, fault_jerk = 0;
  /// They hold from states with no more ṡ than that, what it grows by while s̈ > 0 is let go
  /// included. Only where a smooth plan bends as sharply as its speed allows are they bounded.
  double stop_velocity = kAnyVelocity, fault_velocity = kAnyVelocity;
  /// For a machine that is slower than planned (override, resume), of a smooth plan: slow_* hold up
  /// to `slow_velocity`.
  double slow_velocity = 0;
  double slow_stop_accel = 0, slow_stop_jerk = 0;
  double slow_fault_accel = 0, slow_fault_jerk = 0;
  /// They hold next to rest. What lies between them and slow_*, or stop_* and fault_* that hold up
  /// to `authority_velocity` where that is set, may be used: cycle/stop/stop_margin.hpp.
  double authority_velocity = 0;
  double rest_stop_accel = 0, rest_stop_jerk = 0;
  double rest_fault_accel = 0, rest_fault_jerk = 0;
};
static_assert(std::is_trivially_copyable_v<TimePiece>);

/// Whether the plan rests where `piece` begins.
[[nodiscard]] inline bool begins_at_rest(const TimePiece& piece) noexcept {
  return piece.kind != TimeKind::kMove || (piece.v == 0 && piece.a == 0);
}

}  // namespace meridian
