// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "meridian/rt/cycle_data.hpp"
#include "meridian/rt/state.hpp"
#include "service/dds/messages.hpp"

namespace meridian::stream {

/// What an operator saw may be at most so old when a verb that moves comes in.
inline constexpr std::int64_t kFreshness_ns = 500'000'000;

/// Whether `verb` can set something in motion or make it faster. Hold, abort, disable and reset
/// only ever stop: they are never stale.
[[nodiscard]] constexpr bool needs_freshness(Verb verb) noexcept {
  switch (verb) {
    case Verb::kEnable:
    case Verb::kStart:
    case Verb::kResume:
    case Verb::kFeedOverride:
    case Verb::kRapidOverride:
    case Verb::kJog:
    case Verb::kHome:
      return true;
    case Verb::kDisable:
    case Verb::kHold:
    case Verb::kAbort:
    case Verb::kReset:
      return false;
  }
  return true;
}

/// Remembers when the service published its last statuses, by its own clock.
class StatusTimes {
 public:
  void published(std::uint64_t sequence, std::int64_t now_ns) noexcept {
    entries_[sequence % kEntries] = {sequence, now_ns};
  }
  /// Whether status `sequence` was published no longer than kFreshness_ns ago. A sequence that was
  /// never published, or so long ago that it is forgotten, was not.
  [[nodiscard]] bool is_fresh(std::uint64_t sequence, std::int64_t now_ns) const noexcept {
    const Entry& entry = entries_[sequence % kEntries];
    return entry.time_ns != kNever && entry.sequence == sequence &&
           now_ns - entry.time_ns <= kFreshness_ns;
  }

 private:
  static constexpr std::size_t kEntries = 512;  ///< 20 Hz and changes: far over 500 ms
  static constexpr std::int64_t kNever = INT64_MIN;
  struct Entry {
    std::uint64_t sequence = 0;
    std::int64_t time_ns = kNever;
  };
  std::array<Entry, kEntries> entries_{};
};

/// Returns kStale where a verb that moves quotes an old epoch, another service or a status older
/// than 500 ms by the service's own clock (or none), else kNone.
/// Proof: tests/unit/stream/freshness_test.cpp.
[[nodiscard]] inline Refusal judge_freshness(const dds::CommandRequest& request,
                                             std::uint64_t service_id, std::uint16_t epoch,
                                             const StatusTimes& times,
                                             std::int64_t now_ns) noexcept {
  if (!needs_freshness(request.verb)) return Refusal::kNone;
  const bool is_same_service =
      request.service_id_seen == 0 || request.service_id_seen == service_id;
  const bool is_fresh =
      is_same_service && request.epoch_seen == epoch && times.is_fresh(request.status_seen, now_ns);
  return is_fresh ? Refusal::kNone : Refusal::kStale;
}

}  // namespace meridian::stream
