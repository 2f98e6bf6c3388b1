// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "service/protocol/freshness.hpp"

namespace meridian::interpolator {

/// When telemetry published its last statuses; the commands thread asks. Any thread. A verb that is
/// never stale waits for nobody: hold and abort go past what telemetry, of a lower priority, locks.
class StatusClock {
 public:
  /// A status is published every `period_ns` at least.
  explicit StatusClock(std::int64_t period_ns = 50'000'000) noexcept : period_ns_(period_ns) {}

  void published(const dds::Status& status, std::int64_t now_ns) {
    newest_.store(status.status_sequence, std::memory_order_release);
    const std::lock_guard lock(mutex_);
    times_.published(status.status_sequence, now_ns, stream::rest_of(status.state, status.block));
  }
  [[nodiscard]] Refusal check(const dds::CommandRequest& request, std::uint64_t service_id,
                              std::uint16_t epoch, std::int64_t now_ns, std::uint64_t rest) const {
    if (!stream::needs_freshness(request.verb, request.argument)) return Refusal::kNone;
    const std::lock_guard lock(mutex_);
    return stream::check_freshness(request, service_id, epoch, times_, now_ns, rest);
  }

  /// The sequence of the newest status; 0: none yet. Waits for nobody.
  [[nodiscard]] std::uint64_t newest() const noexcept {
    return newest_.load(std::memory_order_acquire);
  }

  /// As StatusTimes says it, for hands, which ask often: nothing also while telemetry has the lock.
  [[nodiscard]] std::optional<std::int64_t> superseded_for(std::uint64_t sequence,
                                                           std::int64_t now_ns) const {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? times_.superseded_for(sequence, now_ns, period_ns_) : std::nullopt;
  }

 private:
  const std::int64_t period_ns_;
  std::atomic<std::uint64_t> newest_{0};
  mutable std::mutex mutex_;
  stream::StatusTimes times_;
};

}  // namespace meridian::interpolator
