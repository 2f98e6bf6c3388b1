// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// How far the session that holds the machine is, and the one function that changes it.
namespace meridian::stream {

enum class SessionPhase : std::uint8_t {
  kFree,            ///< no session holds the machine
  kOpen,            ///< blocks come
  kComplete,        ///< the end mark is in
  kRefused,         ///< nothing more is accepted, nor an end: what is in is run
  kRefusedComplete  ///< the end mark is in, and a block before it was refused afterwards
};
inline constexpr int kSessionPhaseCount = 5;

enum class SessionEvent : std::uint8_t {
  kOpened,     ///< a station has the machine
  kEndMark,    ///< a batch with the end mark was accepted
  kRefused,    ///< a block, a batch or the station itself ended what is accepted
  kEndIsLost,  ///< the same, and the end mark found no room either
  kOver        ///< the program ran, was aborted, or nothing of it is in
};
inline constexpr int kSessionEventCount = 5;

/// The phase behind `event`. A session that is not there, or refused, stays so until it is over.
/// Proof: tests/unit/protocol/session_phase_test.cpp.
[[nodiscard]] constexpr SessionPhase phase_after(SessionPhase phase, SessionEvent event) noexcept {
  using enum SessionPhase;
  if (event == SessionEvent::kOver) return kFree;
  if (event == SessionEvent::kOpened) return phase == kFree ? kOpen : phase;
  if (phase == kFree) return kFree;
  switch (event) {
    case SessionEvent::kEndMark:
      return phase == kOpen ? kComplete : phase;
    case SessionEvent::kRefused:
      return phase == kOpen ? kRefused : phase == kComplete ? kRefusedComplete : phase;
    default:
      return kRefused;  // kEndIsLost
  }
}

/// Whether the station may send more blocks.
[[nodiscard]] constexpr bool is_accepting(SessionPhase phase) noexcept {
  return phase == SessionPhase::kOpen;
}
/// Whether the end mark is in.
[[nodiscard]] constexpr bool has_end_mark(SessionPhase phase) noexcept {
  return phase == SessionPhase::kComplete || phase == SessionPhase::kRefusedComplete;
}
/// Whether nothing of the session is accepted any more, and the machine is still its own.
[[nodiscard]] constexpr bool is_refused(SessionPhase phase) noexcept {
  return phase == SessionPhase::kRefused || phase == SessionPhase::kRefusedComplete;
}

}  // namespace meridian::stream
