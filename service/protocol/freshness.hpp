// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/state.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

/// What an operator saw may be at most so old when a verb that moves comes in.
inline constexpr std::int64_t kFreshness_ns = 500'000'000;

/// Whether `verb` can set something in motion or make it faster. Hold, abort, disable and reset
/// only ever stop, and so do single block, optional stops and the dry run that are switched on:
/// they are never stale.
[[nodiscard]] constexpr bool needs_freshness(Verb verb, double argument) noexcept {
  switch (verb) {
    case Verb::kEnable:
    case Verb::kStart:
    case Verb::kResume:
    case Verb::kFeedOverride:
    case Verb::kRapidOverride:
    case Verb::kJog:
    case Verb::kHome:
    case Verb::kFrame:
    case Verb::kTool:
    case Verb::kLimits:
      return true;
    case Verb::kSingleBlock:
    case Verb::kOptionalStop:
    case Verb::kDryRun:
      return argument != 1;
    case Verb::kDisable:
    case Verb::kHold:
    case Verb::kAbort:
    case Verb::kReset:
      return false;
  }
  return true;
}

/// Names the block behind which a machine in `state` rests that runs `block`; 0: behind none.
[[nodiscard]] constexpr std::uint64_t rest_of(State state, std::uint64_t block) noexcept {
  return state == State::kStepping ? block + 1 : 0;
}

/// Remembers when the service published its last statuses, by its own clock.
class StatusTimes {
 public:
  /// `rest`: behind which block the machine rested then, see rest_of().
  void published(std::uint64_t sequence, std::int64_t now_ns, std::uint64_t rest = 0) noexcept {
    entries_[sequence % kEntries] = {sequence, now_ns, rest};
  }
  /// The rest that status `sequence` reported; 0: none, or forgotten.
  [[nodiscard]] std::uint64_t rest_reported(std::uint64_t sequence) const noexcept {
    const Entry& entry = entries_[sequence % kEntries];
    return entry.sequence == sequence ? entry.rest : 0;
  }
  /// Whether status `sequence` was published no longer than kFreshness_ns ago. A sequence that was
  /// never published, or so long ago that it is forgotten, was not.
  [[nodiscard]] bool is_fresh(std::uint64_t sequence, std::int64_t now_ns) const noexcept {
    const Entry& entry = entries_[sequence % kEntries];
    return entry.time_ns != kNever && entry.sequence == sequence &&
           now_ns - entry.time_ns <= kFreshness_ns;
  }

  /// For how long, ns, there has been a newer status than `sequence`, or should have been: where
  /// none is published any more the newest is superseded two periods after it. 0: not yet. Nothing:
  /// that was never published, or is forgotten.
  [[nodiscard]] std::optional<std::int64_t> superseded_for(std::uint64_t sequence,
                                                           std::int64_t now_ns,
                                                           std::int64_t period_ns) const noexcept {
    const Entry& entry = entries_[sequence % kEntries];
    const Entry& next = entries_[(sequence + 1) % kEntries];
    if (entry.time_ns == kNever || entry.sequence != sequence) return std::nullopt;
    const bool is_newest = next.time_ns == kNever || next.sequence != sequence + 1;
    const std::int64_t due_ns = entry.time_ns + 2 * period_ns;
    const std::int64_t since_ns = is_newest ? due_ns : std::min(due_ns, next.time_ns);
    return std::max<std::int64_t>(0, now_ns - since_ns);
  }

 private:
  static constexpr std::size_t kEntries = 512;  ///< 20 Hz and changes: far over 500 ms
  static constexpr std::int64_t kNever = INT64_MIN;
  struct Entry {
    std::uint64_t sequence = 0;
    std::int64_t time_ns = kNever;
    std::uint64_t rest = 0;
  };
  std::array<Entry, kEntries> entries_{};
};

/// Returns kStale where a verb that moves quotes an old epoch, another service or a status older
/// than 500 ms by the service's own clock (or none), else kNone. After a block (`rest`, see
/// rest_of()) start and resume are stale too where that status showed another rest: said twice
/// they send on once.
/// Proof: tests/unit/protocol/freshness_test.cpp.
[[nodiscard]] inline Refusal check_freshness(const dds::CommandRequest& request,
                                             std::uint64_t service_id, std::uint16_t epoch,
                                             const StatusTimes& times, std::int64_t now_ns,
                                             std::uint64_t rest = 0) noexcept {
  if (!needs_freshness(request.verb, request.argument)) return Refusal::kNone;
  const bool is_same_service =
      request.service_id_seen == 0 || request.service_id_seen == service_id;
  const bool is_fresh =
      is_same_service && request.epoch_seen == epoch && times.is_fresh(request.status_seen, now_ns);
  const bool sends_on = request.verb == Verb::kStart || request.verb == Verb::kResume;
  const bool is_of_rest =
      !sends_on || rest == 0 || times.rest_reported(request.status_seen) == rest;
  return is_fresh && is_of_rest ? Refusal::kNone : Refusal::kStale;
}

}  // namespace meridian::stream
