// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/cycle/state_table.hpp"

namespace meridian::interpolator {

/// Commands on their way to the cycle, numbered by next_request() in the order in which they came.
/// Those of the commands thread stand in a row and are read one in a cycle; a stop stands in none:
/// any thread stages it, the cycle reads it in its next period, after older stops of another verb
/// at most, and there is always room for it. Of stops of one verb the newest stands for those that
/// were not read yet. What a stop overtakes is the cycle's to decide (obey()).
///
/// Memory order. A stop is stored with release before the commands that came after it are
/// published; the cycle looks at the row (acquire) before it looks for stops. So where it sees a
/// command, it sees every stop that came before publish() showed that command: a start never slips
/// out in front of an abort that came with it. RT: try_pop() in the cycle, wait-free. Proof:
/// tests/unit/daemon/command_port_test.cpp.
class CommandPort {
 public:
  /// Any thread: the number of the next command, never 0.
  [[nodiscard]] std::uint64_t next_request() noexcept {
    return newest_request_.fetch_add(1, std::memory_order_relaxed) + 1;
  }
  /// Any thread, wait-free but for others that stage the same verb: a stop for the next cycle. Does
  /// nothing for a verb that is none.
  void stage_stop(Verb verb, std::uint64_t request) noexcept {
    for (std::size_t i = 0; i < kStops.size(); ++i) {
      if (verb != kStops[i]) continue;
      std::uint64_t newest = stops_[i].load(std::memory_order_relaxed);
      while (newest < request &&
             !stops_[i].compare_exchange_weak(newest, request, std::memory_order_release,
                                              std::memory_order_relaxed)) {
      }
    }
  }
  /// Commands thread: stages a stop, or puts a command behind the others, not seen before
  /// publish(). False and nothing changed: the row is full.
  [[nodiscard]] bool stage(const Command& command) noexcept {
    if (!is_stop(command.verb)) return words_.stage(command);
    stage_stop(command.verb, command.request);
    return true;
  }
  /// Commands thread: shows the cycle what was staged.
  void publish() noexcept { words_.publish(); }

  /// Cycle: takes the next command, a stop first; false if there is none.
  [[nodiscard]] bool try_pop(Command& command) noexcept {
    const Command* oldest = words_.peek(0);
    if (take_stop(command)) return true;
    if (oldest == nullptr) return false;
    command = *oldest;
    words_.drop(1);
    return true;
  }

 private:
  static constexpr std::array kStops{Verb::kHold, Verb::kAbort, Verb::kDisable};
  static_assert([] {
    int stops = 0;
    for (int v = 0; v < kVerbCount; ++v) stops += is_stop(static_cast<Verb>(v)) ? 1 : 0;
    for (const Verb verb : kStops) stops -= is_stop(verb) ? 1 : 0;
    return stops == 0;
  }());

  /// The oldest stop that was not taken yet.
  [[nodiscard]] bool take_stop(Command& command) noexcept {
    std::uint64_t oldest = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < kStops.size(); ++i) {
      const std::uint64_t asked = stops_[i].load(std::memory_order_acquire);
      if (asked == taken_[i] || (oldest != 0 && oldest < asked)) continue;
      oldest = asked;
      at = i;
    }
    if (oldest == 0) return false;
    taken_[at] = oldest;
    command = {.request = oldest, .verb = kStops[at], .argument = 0};
    return true;
  }

  SpscRing<Command, 64> words_;
  std::atomic<std::uint64_t> newest_request_{0};
  std::array<std::atomic<std::uint64_t>, kStops.size()> stops_{};  ///< newest of each; 0: none yet
  std::array<std::uint64_t, kStops.size()> taken_{};               ///< the cycle's

  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

}  // namespace meridian::interpolator
