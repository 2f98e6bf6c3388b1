// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian::drive {

/// Wake-ups at start + n periods: a thread that oversleeps keeps its phase and learns how many it
/// lost.
class Pace {
 public:
  explicit Pace(std::int64_t period_ns) noexcept;

  /// Sleeps until the next wake-up; returns how many were lost before it.
  int sleep() noexcept;
  /// When it woke, on the monotonic clock.
  [[nodiscard]] std::int64_t now_ns() const noexcept { return now_ns_; }

 private:
  std::int64_t period_ns_, due_ns_, now_ns_;
};

/// Of the monotonic clock.
[[nodiscard]] std::int64_t monotonic_ns() noexcept;

/// The calling thread at that SCHED_FIFO priority while this lives, then in the class it had
/// before. 0, or no right to it: it stays in its class.
class RaisedPriority {
 public:
  explicit RaisedPriority(int priority) noexcept;
  ~RaisedPriority();
  RaisedPriority(const RaisedPriority&) = delete;
  RaisedPriority& operator=(const RaisedPriority&) = delete;

  [[nodiscard]] bool is_raised() const noexcept { return is_raised_; }

 private:
  int policy_before_ = 0, priority_before_ = 0;
  bool is_raised_ = false;
};

/// Whether threads of this process may have that priority; false for 0. Context: start-up.
[[nodiscard]] bool may_have_priority(int priority);

/// The calling thread, and those that it starts, off the last processor: a service on this host
/// uses it for its cycle.
void keep_off_last_processor() noexcept;

}  // namespace meridian::drive
