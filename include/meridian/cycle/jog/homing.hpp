// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/stop/on_path.hpp"

/// Homing: drives find their references by themselves, in CiA 402 homing mode, one group after the
/// other in the order of the machine file. The setpoint of a drive that is homing is its feedback;
/// before and after that it holds its place. The drives of a stage home together, for each of them
/// carries both joints.
/// RT: cycle. Proof: tests/unit/cycle/homing_test.cpp.
namespace meridian {

/// How long drives take at most to go into homing mode, to stop searching and to come back.
inline constexpr double kChangeMode_s = 2.0;
/// A drive that finds its reference so fast that nobody sees it search counts after that time.
inline constexpr double kSearchUnseen_s = 0.5;

/// What the drives are asked for, by joint.
struct HomingAsked {
  std::uint32_t mode_mask = 0;   ///< to be in homing mode
  std::uint32_t start_mask = 0;  ///< to search
};

[[nodiscard]] inline HomingAsked asked_of(const Homing& homing) noexcept {
  using Phase = Homing::Phase;
  if (!homing.is_active() || homing.phase >= Phase::kLeave) return {};
  return {homing.busy, homing.phase == Phase::kSearch ? homing.busy : 0};
}

/// The turn of `joint`, from 1 on; both joints of a stage have the earlier one of theirs.
[[nodiscard]] inline int homing_turn(const MachineModel& machine, const CycleOptions& options,
                                     int joint) noexcept {
  const auto own = [&options](int which) {
    const int turn = options.homing_turns[static_cast<std::size_t>(which)];
    return turn > 0 ? turn : which + 1;
  };
  if (!is_on_stage(machine, joint)) return own(joint);
  return std::min(own(machine.stage.linear_joint), own(machine.stage.rotary_joint));
}

inline void enter_phase(Homing& homing, Homing::Phase next) noexcept {
  homing.phase = next;
  homing.time = 0;
}

/// Takes the joints whose turn is next. False where none is left.
inline bool take_group(const MachineModel& machine, const CycleOptions& options,
                       Homing& homing) noexcept {
  int turn = std::numeric_limits<int>::max();
  for (std::uint32_t left = homing.left; left != 0; left &= left - 1) {
    turn = std::min(turn, homing_turn(machine, options, std::countr_zero(left)));
  }
  homing.busy = homing.begun = 0;
  for (std::uint32_t left = homing.left; left != 0; left &= left - 1) {
    const int joint = std::countr_zero(left);
    if (homing_turn(machine, options, joint) != turn) continue;
    homing.busy |= 1U << static_cast<unsigned>(joint);
  }
  homing.left &= ~homing.busy;
  enter_phase(homing, Homing::Phase::kBegin);
  return homing.busy != 0;
}

/// Begins to home the joints of `mask`; one of a stage takes the other along.
[[nodiscard]] inline Homing begin_homing(const MachineModel& machine, const CycleOptions& options,
                                         std::uint32_t mask) noexcept {
  Homing homing;
  const std::uint32_t pair = stage_pair(machine);
  homing.left = (mask & pair) != 0 ? mask | pair : mask;
  (void)take_group(machine, options, homing);
  return homing;
}

/// Asks the drives to stop searching; the joints whose turn has not come keep their place.
inline void halt_homing(Homing& homing) noexcept {
  homing.left = 0;
  if (homing.phase <= Homing::Phase::kSearch) enter_phase(homing, Homing::Phase::kHalt);
}

/// Reports why `joint` has no reference and gives the rest of the homing up.
inline void fail_homing(Cycle& c, Alarm alarm, std::uint32_t joints) noexcept {
  emit(c, EventCode::kAlarm, static_cast<std::uint64_t>(alarm),
       static_cast<std::uint64_t>(std::countr_zero(joints)), c.state.homing.time);
  c.state.homing.has_failed = true;
  halt_homing(c.state.homing);
}

/// Setpoints of the drives that are in homing mode go where they report to be; whoever is not there
/// yet, or back already, follows setpoints and must be held. Of a stage both or none.
inline void let_homing_move(Cycle& c) noexcept {
  std::uint32_t moving = c.state.homing.busy & c.drives.homing_mask;
  const std::uint32_t pair = stage_pair(c.machine);
  if ((moving & pair) != pair) moving &= ~pair;
  for (; moving != 0; moving &= moving - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(moving));
    if (!std::isfinite(c.feedback[i])) continue;  // nobody reports: raise() knows
    c.previous[i] = c.state.joints[i] = c.feedback[i];
  }
}

/// One cycle of searching.
inline void watch_search(Cycle& c) noexcept {
  Homing& homing = c.state.homing;
  const Feedback& f = c.drives;
  homing.begun |= homing.busy & ~f.homed_mask & ~f.homing_error_mask;
  const std::uint32_t seen =
      homing.time > kSearchUnseen_s ? homing.busy : homing.busy & homing.begun;
  const std::uint32_t there = seen & f.homed_mask & f.referenced_mask;
  const std::uint32_t failed = seen & f.homing_error_mask;  // not the one of the time before
  if (failed != 0) return fail_homing(c, Alarm::kHomingFailed, failed);
  if (there == homing.busy) return enter_phase(homing, Homing::Phase::kLeave);
  if (homing.time > c.state.options.homing_timeout_s) {
    fail_homing(c, Alarm::kHomingTimeout, homing.busy & ~there);
  }
}

/// The group is done: the next one's turn, or the end. False at the end.
[[nodiscard]] inline bool finish_group(Cycle& c) noexcept {
  Homing& homing = c.state.homing;
  const std::uint32_t referenced = homing.busy & c.drives.referenced_mask;
  if (!homing.has_failed && referenced != 0) emit(c, EventCode::kJointsHomed, referenced);
  if (take_group(c.machine, c.state.options, homing)) return true;
  homing = {};
  return false;
}

enum class HomingStep : std::uint8_t {
  kGoesOn,
  kStuck,  ///< the same, and drives do not come back from homing mode
  kOver    ///< whatever became of it
};

/// One cycle of Homing.
[[nodiscard]] inline HomingStep follow_homing(Cycle& c) noexcept {
  using Phase = Homing::Phase;
  Homing& homing = c.state.homing;
  const Feedback& f = c.drives;
  rest(c.state);
  homing.time += c.dt * c.periods;
  const bool is_late = homing.time > kChangeMode_s;
  const HomingStep step = is_late ? HomingStep::kStuck : HomingStep::kGoesOn;
  if (homing.phase != Phase::kSettle) let_homing_move(c);
  switch (homing.phase) {
    case Phase::kNone:
      return HomingStep::kOver;
    case Phase::kBegin:
      if ((f.homing_mask & homing.busy) == homing.busy) {
        enter_phase(homing, Phase::kSearch);
      } else if (is_late) {
        fail_homing(c, Alarm::kHomingTimeout, homing.busy & ~f.homing_mask);
      }
      return HomingStep::kGoesOn;
    case Phase::kSearch:
      watch_search(c);
      return HomingStep::kGoesOn;
    case Phase::kHalt:
      if ((f.homing_mask & homing.busy & ~f.still_mask) == 0 || is_late) {
        enter_phase(homing, Phase::kLeave);
      }
      return HomingStep::kGoesOn;
    case Phase::kLeave:
      if ((f.homing_mask & homing.busy) == 0) {
        enter_phase(homing, Phase::kSettle);
        homing.settled_cycle = c.in.cycle;
      }
      return step;
    case Phase::kSettle: {
      const bool goes_on = f.cycle_seen < homing.settled_cycle || finish_group(c);
      return goes_on || is_late ? step : HomingStep::kOver;
    }
  }
  return HomingStep::kGoesOn;
}

}  // namespace meridian
