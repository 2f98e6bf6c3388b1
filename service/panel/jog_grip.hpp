// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace meridian::panel {

/// The pressed key or pointer of one page, from the first beat to the last. It is let go where the
/// page says so, where its beats stay away (focus lost, tab hidden, socket cut, page frozen,
/// browser killed) and where a beat shows that the page sees the machine late. Once let go it stays
/// so: what comes in later presses nothing. Any thread. Time is an argument. Proof:
/// tests/panel/operating_test.cpp.
class JogGrip {
 public:
  using Clock = std::chrono::steady_clock;
  /// A page beats every 40 ms; without a beat for so long it is let go.
  static constexpr std::chrono::milliseconds kDeadMan{150};

  JogGrip(std::uint64_t page, std::uint64_t number, Clock::time_point now)
      : page_(page), number_(number), beat_ns_(ns_of(now)) {}

  [[nodiscard]] bool is_of(std::uint64_t page, std::uint64_t number) const noexcept {
    return page == page_ && number == number_;
  }
  /// Whether `number` was pressed on this page before this grip was.
  [[nodiscard]] bool is_older(std::uint64_t page, std::uint64_t number) const noexcept {
    return page == page_ && number < number_;
  }
  [[nodiscard]] std::uint64_t page() const noexcept { return page_; }

  void beat(Clock::time_point now) noexcept {
    check(now);
    beat_ns_ = ns_of(now);
  }
  /// Lets go where the last beat is too long ago.
  void check(Clock::time_point now) noexcept {
    constexpr std::int64_t kDeadMan_ns = std::chrono::nanoseconds(kDeadMan).count();
    if (ns_of(now) - beat_ns_.load() > kDeadMan_ns) let_go();
  }
  void let_go() noexcept { is_let_go_ = true; }
  [[nodiscard]] const std::atomic<bool>& is_let_go() const noexcept { return is_let_go_; }

 private:
  [[nodiscard]] static std::int64_t ns_of(Clock::time_point time) noexcept {
    return std::chrono::nanoseconds(time.time_since_epoch()).count();
  }

  std::uint64_t page_, number_;
  std::atomic<std::int64_t> beat_ns_;
  std::atomic<bool> is_let_go_{false};
};

}  // namespace meridian::panel
