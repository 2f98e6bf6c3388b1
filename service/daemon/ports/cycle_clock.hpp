// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian::interpolator {

/// Number and scheduled time of the period in which a thread woke.
struct Period {
  std::uint64_t number = 0;
  std::int64_t due_ns = 0;
  std::uint32_t lost = 0;  ///< periods between the last one and this that nobody executed
};

/// Wake-up times `start + n * period`. A thread that wakes late skips whole periods, counts them
/// and keeps phase. Proof: tests/unit/daemon/cycle_clock_test.cpp.
class CycleClock {
 public:
  CycleClock(std::int64_t start_ns, std::int64_t period_ns) noexcept
      : start_ns_(start_ns), period_ns_(period_ns) {}

  [[nodiscard]] std::int64_t next_due_ns() const noexcept {
    return start_ns_ + static_cast<std::int64_t>(next_) * period_ns_;
  }

  /// The thread woke at `now_ns`: which period is it?
  [[nodiscard]] Period woke_at(std::int64_t now_ns) noexcept {
    const std::int64_t late_ns = now_ns - next_due_ns();
    const auto lost = late_ns > 0 ? static_cast<std::uint64_t>(late_ns / period_ns_) : 0;
    next_ += lost;
    const Period period{next_, next_due_ns(), static_cast<std::uint32_t>(lost)};
    ++next_;
    return period;
  }

 private:
  std::int64_t start_ns_, period_ns_;
  std::uint64_t next_ = 1;
};

}  // namespace meridian::interpolator
