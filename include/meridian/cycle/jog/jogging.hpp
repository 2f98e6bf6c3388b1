// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/jog/jog_room.hpp"
#include "meridian/cycle/stop/on_path.hpp"

/// Jogging: one joint, or the tool, follows the velocity that an operator holds, for as long as
/// orders keep coming. Its larger parts stay out of line: inlined they made a cycle that cuts 40
/// instructions longer. RT: cycle. Proof: tests/unit/cycle/jogging_test.cpp,
/// tests/property/cycle/jog_motion_test.cpp.
namespace meridian {

/// The first order must come in so long after the verb.
inline constexpr double kFirstOrder_s = 0.5;
/// No operator may ask for a longer dead man's time.
inline constexpr double kLongestDeadMan_s = 0.5;

/// Orders up to `sample`, and of another hand than `request`, are none of this hand's.
[[nodiscard]] inline Jogging begin_jogging(std::uint64_t request, std::uint64_t sample) noexcept {
  Jogging jogging;
  jogging.hold = Jogging::Hold::kHeld;
  jogging.hand = request;
  jogging.order.sample = sample;
  jogging.order.dead_man_s = kFirstOrder_s;
  return jogging;
}

/// A hand that was silent for longer than its dead man's time let go.
inline void check_silence(Jogging& jogging) noexcept {
  if (!(jogging.silence <= jogging.order.dead_man_s)) jogging.hold = Jogging::Hold::kReleased;
}

/// Counts the silence, `elapsed` s with periods which nobody saw, and takes a newer order of
/// `epoch` where the hand is still there: one that let go is not taken again. The silence is
/// counted from when the order was said: what a wire delays moves nothing for longer than the dead
/// man's time, and an order that is older when it comes in is passed over, where it does not let
/// go.
inline void take_order(Jogging& jogging, const JogOrder& order, std::uint16_t epoch,
                       double elapsed) noexcept {
  jogging.silence += elapsed;
  check_silence(jogging);
  const bool is_late = order.age_s > order.dead_man_s && order.velocity != 0;
  const bool is_mine = order.hand == jogging.hand && order.epoch == epoch && !is_late;
  if (is_mine && order.sample > jogging.order.sample && !jogging.is_let_go()) {
    jogging.has_order = true;
    jogging.order = order;
    jogging.order.dead_man_s = std::clamp(order.dead_man_s, 0.0, kLongestDeadMan_s);
    jogging.silence = order.age_s;
    check_silence(jogging);
  }
}

/// Narrows the room to the distance that was asked for.
inline void keep_distance(Jogging& jogging) noexcept {
  jogging.distance = jogging.order.distance;
  if (!(jogging.order.distance > 0)) return;
  const double from = jogging.axis.at.q;
  jogging.axis.low = std::max(jogging.axis.low, from - jogging.order.distance);
  jogging.axis.high = std::min(jogging.axis.high, from + jogging.order.distance);
}

inline void take_room(Jogging& jogging, const JogRoom& room) noexcept {
  jogging.axis = room.axis;
  jogging.fault = room.fault;
  jogging.is_ready = true;
  keep_distance(jogging);
}

/// Goes on with the survey of the tool's way, after which it may move.
[[gnu::noinline]] inline void survey_path(Jogging& jogging, const MachineModel& machine) noexcept {
  if (jogging.is_ready || jogging.joint < kMaxJoints) return;
  jogging.survey.go_on(machine, jogging.tool_path);
  if (jogging.survey.is_over()) take_room(jogging, jogging.survey.room(machine, jogging.tool_path));
}

/// What the order in force is for, as Jogging::joint says it.
[[nodiscard]] inline int joint_of(const JogOrder& order) noexcept {
  return order.joint + (order.is_tool ? kMaxJoints : 0);
}

/// Whether the hand is on what the order in force is for, and as far as it says.
[[nodiscard]] inline bool is_in_hand(const Jogging& jogging) noexcept {
  return joint_of(jogging.order) == jogging.joint && jogging.order.distance == jogging.distance;
}

/// Puts the hand on what is asked for, where nothing moves and it may be jogged.
inline void choose_axis(Jogging& jogging, const MachineModel& machine, const JointVector& joints,
                        std::uint32_t referenced) noexcept {
  const JogOrder& order = jogging.order;
  const int joint = joint_of(order);
  if (is_in_hand(jogging)) return survey_path(jogging, machine);
  if (!jogging.axis.is_at_rest()) return;
  jogging.joint = -1;
  jogging.is_ready = false;
  if (!jogging.has_order || jogging.is_let_go() || !may_jog(machine, joint, referenced)) return;
  if (!order.is_tool) {
    jogging.joint = joint;
    return take_room(jogging, jog_room(machine, order.tool_length_mm, joints, joint, referenced));
  }
  const bool has_path = find_tool_path(machine, joints, order.tool_length_mm,
                                       static_cast<ToolAxis>(order.joint), jogging.tool_path);
  if (!has_path) return;
  jogging.joint = joint;
  jogging.distance = order.distance;
  jogging.axis = {};
  jogging.survey = ToolSurvey(machine, jogging.tool_path, joints, order.distance);
}

/// Takes the hand off; the joints stay where they are.
inline void end_jogging(CycleState& state) noexcept {
  state.jogging = {};
  rest(state);
}

/// The joints are where the axis is. False where there are none.
[[nodiscard, gnu::noinline]] inline bool put_jogged(const MachineModel& machine,
                                                    CycleState& state) noexcept {
  const Jogging& jogging = state.jogging;
  state.velocity = {};
  if (!jogging.is_ready) return true;
  if (jogging.joint < kMaxJoints) {
    state.joints[static_cast<std::size_t>(jogging.joint)] = jogging.axis.at.q;
    state.velocity[static_cast<std::size_t>(jogging.joint)] = jogging.axis.at.v;
    return true;
  }
  const auto at =
      joints_on(machine, jogging.tool_path, Jet<1>::variable(jogging.axis.at.q), state.joints);
  if (at.status != SolveStatus::kOk) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
    state.joints[i] = value_of(at.q[i]);
    state.velocity[i] = at.q[i].derivative(1) * jogging.axis.at.v;
  }
  return true;
}

enum class JogStep : std::uint8_t {
  kGoesOn,
  kOver,     ///< the hand is gone, and the joints rest
  kNoJoints  ///< the way gave no joints: what the survey saw was not so
};

/// One cycle of Jogging.
[[nodiscard, gnu::noinline]] inline JogStep follow_jogging(Cycle& c) noexcept {
  Jogging& jogging = c.state.jogging;
  // c.periods is 1 where nothing moved
  take_order(jogging, c.in.jog, c.state.epoch, c.dt * (1.0 + c.in.lost_periods));
  choose_axis(jogging, c.machine, c.state.joints, c.drives.referenced_mask);
  const bool is_held = !jogging.is_let_go() && is_in_hand(jogging);
  const double fastest = c.in.max_jog_speed;
  const double velocity = std::clamp(jogging.order.velocity, -fastest, fastest);
  for (int n = 0; n < c.periods && jogging.is_ready; ++n) {
    follow(jogging.axis, is_held ? velocity : 0, c.dt);
  }
  if (!put_jogged(c.machine, c.state)) return JogStep::kNoJoints;
  if (!jogging.is_let_go() || !jogging.axis.is_at_rest()) return JogStep::kGoesOn;
  end_jogging(c.state);
  return JogStep::kOver;
}

/// Takes the hand off by the operator's word or a fault: the joint brakes, with the limits of a
/// FaultStop or its own.
[[gnu::noinline]] inline void brake_jogging(Jogging& jogging, bool is_fault) noexcept {
  jogging.hold = Jogging::Hold::kReleased;
  if (jogging.is_ready) brake(jogging.axis, is_fault ? jogging.fault : jogging.axis.rates);
}

/// One cycle of braking.
[[nodiscard, gnu::noinline]] inline JogStep follow_braking(Cycle& c) noexcept {
  Jogging& jogging = c.state.jogging;
  for (int n = 0; n < c.periods && jogging.is_ready; ++n) {
    jogging.axis.ramp.advance(jogging.axis.at, c.dt);
  }
  if (!put_jogged(c.machine, c.state)) return JogStep::kNoJoints;
  if (!jogging.axis.is_at_rest()) return JogStep::kGoesOn;
  end_jogging(c.state);
  return JogStep::kOver;
}

}  // namespace meridian
