// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/state.hpp"

/// What each verb does in each state: this table is what the cycle executes, what the tests check
/// and what docs/operating.md prints (tests/unit/cycle/state_table_test.cpp holds them equal).
namespace meridian {

enum class Effect : std::uint8_t {
  kRefused,  ///< nothing happens; `refusal` says why
  kAlready,  ///< accepted, nothing to do
  kGo,       ///< accepted, the machine goes to state `next`
  kSet       ///< accepted, a value is set
};

struct VerbEffect {
  Effect effect = Effect::kRefused;
  State next = State::kOff;  ///< kGo only
  Refusal refusal = Refusal::kNone;
};

namespace state_table {

inline constexpr VerbEffect kSame{Effect::kAlready, State::kOff, Refusal::kNone};
inline constexpr VerbEffect kValue{Effect::kSet, State::kOff, Refusal::kNone};
inline constexpr VerbEffect kNo{Effect::kRefused, State::kOff, Refusal::kWrongState};
inline constexpr VerbEffect kEmpty{Effect::kRefused, State::kOff, Refusal::kNoProgram};
inline constexpr VerbEffect kTaken{Effect::kRefused, State::kOff, Refusal::kProgramPresent};
inline constexpr VerbEffect kBroken{Effect::kRefused, State::kOff, Refusal::kFaultPresent};
[[nodiscard]] constexpr VerbEffect go(State next) { return {Effect::kGo, next, Refusal::kNone}; }

using Row = std::array<VerbEffect, kVerbCount>;

inline constexpr VerbEffect kEna = go(State::kEnabling), kDis = go(State::kDisabling),
                            kRun = go(State::kRunning), kAbo = go(State::kAborting),
                            kHol = go(State::kHolding), kJog = go(State::kJogging),
                            kHom = go(State::kHoming);

// clang-format off
/// One row per state in the order of State, one column per verb in the order of Verb. Conditions
/// that a table cannot hold (feedback there, joints referenced, fault gone, argument in range) are
/// checked after it, in cycle/obey.hpp, and can only refuse more.
inline constexpr std::array<Row, kStateCount> kTable{{
    //            enable   disable  start                    hold              resume  abort    reset            overrides      jog      home     single  optional dry     frame   tool    limits
    /* Off     */ {kEna,    kSame,   kNo,                     kNo,              kNo,    kNo,     kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kValue, kValue, kValue, kValue},
    /* Enabling*/ {kSame,   kDis,    kNo,                     kNo,              kNo,    kNo,     kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Ready   */ {kSame,   kDis,    kEmpty,                  kNo,              kNo,    kAbo,    kSame,           kValue, kValue, kJog,   kHom,    kValue, kValue, kNo, kValue, kValue, kValue},
    /* Loaded  */ {kSame,   kDis,    go(State::kApproaching), kNo,              kNo,    kAbo,    kSame,           kValue, kValue, kTaken, kTaken,  kValue, kValue, kNo, kTaken, kTaken, kTaken},
    /* Approach*/ {kSame,   kNo,     kSame,                   kHol,             kSame,  kAbo,    kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Running */ {kSame,   kNo,     kSame,                   kHol,             kSame,  kAbo,    kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Holding */ {kSame,   kNo,     kNo,                     kSame,            kNo,    kAbo,    kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Held    */ {kSame,   kDis,    kNo,                     kSame,            kRun,   kAbo,    kSame,           kValue, kValue, kTaken, kTaken,  kValue, kValue, kNo, kTaken, kTaken, kTaken},
    /* Starving*/ {kSame,   kNo,     kNo,                     kHol,             kNo,    kAbo,    kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Starved */ {kSame,   kDis,    kNo,                     go(State::kHeld), kRun,   kAbo,    kSame,           kValue, kValue, kTaken, kTaken,  kValue, kValue, kNo, kTaken, kTaken, kTaken},
    /* Aborting*/ {kSame,   kNo,     kNo,                     kSame,            kNo,    kSame,   kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Disablin*/ {kNo,     kSame,   kNo,                     kNo,              kNo,    kNo,     kSame,           kValue, kValue, kNo,    kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* FaultSto*/ {kBroken, kBroken, kBroken,                 kSame,            kNo,    kSame,   kNo,             kValue, kValue, kBroken, kBroken, kValue, kValue, kBroken, kBroken, kBroken, kBroken},
    /* Fault   */ {kBroken, kSame,   kBroken,                 kNo,              kNo,    kSame,   go(State::kOff), kValue, kValue, kBroken, kBroken, kValue, kValue, kBroken, kBroken, kBroken, kBroken},
    /* Jogging */ {kSame,   kNo,     kNo,                     kAbo,             kNo,    kAbo,    kSame,           kValue, kValue, kNo,     kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Homing  */ {kSame,   kNo,     kNo,                     kAbo,             kNo,    kAbo,    kSame,           kValue, kValue, kNo,     kNo,     kValue, kValue, kNo, kNo, kNo, kNo},
    /* Stepping*/ {kSame,   kDis,    kRun,                    go(State::kHeld), kRun,   kAbo,    kSame,           kValue, kValue, kTaken, kTaken, kValue, kValue, kNo, kTaken, kTaken, kTaken},
}};
// clang-format on

}  // namespace state_table

/// Returns what `verb` does in `state`. RT: cycle.
[[nodiscard]] constexpr VerbEffect effect_of(State state, Verb verb) noexcept {
  return state_table::kTable[static_cast<std::size_t>(state)][static_cast<std::size_t>(verb)];
}

[[nodiscard]] constexpr const char* name_of(State state) noexcept {
  constexpr std::array<const char*, kStateCount> kNames{
      "Off",       "Enabling", "Ready",    "Loaded",  "Approaching", "Running",
      "Holding",   "Held",     "Starving", "Starved", "Aborting",    "Disabling",
      "FaultStop", "Fault",    "Jogging",  "Homing",  "Stepping"};
  return kNames[static_cast<std::size_t>(state)];
}

[[nodiscard]] constexpr const char* name_of(Verb verb) noexcept {
  constexpr std::array<const char*, kVerbCount> kNames{
      "enable",        "disable",       "start",          "hold", "resume", "abort",
      "reset",         "feed_override", "rapid_override", "jog",  "home",   "single_block",
      "optional_stop", "dry_run",       "frame",          "tool", "limits"};
  return kNames[static_cast<std::size_t>(verb)];
}

[[nodiscard]] constexpr const char* name_of(Refusal refusal) noexcept {
  constexpr std::array<const char*, 22> kNames{"none",
                                               "wrong state",
                                               "not referenced",
                                               "no program",
                                               "no feedback",
                                               "out of range",
                                               "stale",
                                               "fault present",
                                               "program present",
                                               "slow ramp",
                                               "drive enabled",
                                               "dry run",
                                               "drive contested",
                                               "not a dry run",
                                               "overtaken",
                                               "no enabling device",
                                               "drives taken",
                                               "drives astray",
                                               "not journalled",
                                               "no probe",
                                               "probe in contact",
                                               "guard open"};
  static_assert(kNames.size() == static_cast<std::size_t>(Refusal::kGuardOpen) + 1);
  const auto i = static_cast<std::size_t>(refusal);
  return i < kNames.size() ? kNames[i] : "unknown";
}

/// Whether `verb` may be said for a dry run alone, by an argument of 1: it leads to motion.
[[nodiscard]] constexpr bool may_be_dry(Verb verb) noexcept {
  return verb == Verb::kEnable || verb == Verb::kStart;
}

/// Whether `verb` is said for a dry run alone.
[[nodiscard]] constexpr bool is_said_dry(Verb verb, double argument) noexcept {
  return may_be_dry(verb) && argument == 1;
}

/// Whether `verb` changes the set-up.
[[nodiscard]] constexpr bool is_set_up(Verb verb) noexcept {
  return verb == Verb::kFrame || verb == Verb::kTool || verb == Verb::kLimits;
}

/// Whether `verb` only ever stops: it goes past what was said before it.
[[nodiscard]] constexpr bool is_stop(Verb verb) noexcept {
  return verb == Verb::kHold || verb == Verb::kAbort || verb == Verb::kDisable;
}

/// Whether `verb` leads to motion: said before a stop and not obeyed yet, it is void.
[[nodiscard]] constexpr bool leads_to_motion(Verb verb) noexcept {
  return verb == Verb::kEnable || verb == Verb::kStart || verb == Verb::kResume ||
         verb == Verb::kJog || verb == Verb::kHome;
}

/// True where drives follow setpoints that are not just their own feedback.
[[nodiscard]] constexpr bool is_enabled(State state) noexcept {
  return state != State::kOff && state != State::kDisabling && state != State::kFault;
}

/// True where a fault stops the machine or has stopped it.
[[nodiscard]] constexpr bool is_fault(State state) noexcept {
  return state == State::kFaultStop || state == State::kFault;
}

/// True where motion is executed or brought to rest: that of the program, or of a hand that jogs.
[[nodiscard]] constexpr bool is_on_path(State state) noexcept {
  switch (state) {
    case State::kApproaching:
    case State::kRunning:
    case State::kHolding:
    case State::kStarving:
    case State::kAborting:
    case State::kFaultStop:
    case State::kJogging:
      return true;
    default:
      return false;
  }
}

}  // namespace meridian
