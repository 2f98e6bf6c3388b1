// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "meridian/cycle/histogram.hpp"

namespace meridian::soak {

/// The host took a processor away; monotonic clock.
struct Stall {
  std::int64_t end_ns = 0, length_ns = 0;
  int cpu = 0;
};

/// How long the processor that was away for longest was away, ns: of `stalls`, in the order of
/// their ends, those that ended since `since_ns`, and of them what was before `until_ns`. Stalls of
/// one processor that follow one another at once are one, however many.
/// Proof: tests/unit/soak/host_watch_test.cpp.
[[nodiscard]] std::int64_t longest_away_ns(std::span<const Stall> stalls, std::int64_t since_ns,
                                           std::int64_t until_ns);

/// Sees when the host takes processors away: a thread on each of them, above every other of real
/// time, naps and notes by how much it woke too late. Nothing but the kernel or what is below it
/// keeps such a thread waiting for milliseconds. Without the right to that class it sees nothing.
/// Proof: tests/unit/soak/host_watch_test.cpp.
class HostWatch {
 public:
  /// Sees stalls that drives which bridge `bridge_ns` do not.
  explicit HostWatch(std::int64_t bridge_ns = 50'000'000);
  ~HostWatch();
  HostWatch(const HostWatch&) = delete;
  HostWatch& operator=(const HostWatch&) = delete;

  /// Those that ended since `since_ns` of the monotonic clock, in that order.
  [[nodiscard]] std::vector<Stall> stalls_since(std::int64_t since_ns) const;
  /// By how much the thread on `cpu` has woken too late, all of its life.
  [[nodiscard]] Histogram lateness(int cpu) const;
  /// Over all of its life: stalls of at least kStall_ns, and the longest, s.
  [[nodiscard]] std::uint64_t stalls() const;
  [[nodiscard]] double longest_s() const;

  /// Whether every processor is watched.
  [[nodiscard]] bool is_watching() const noexcept { return watched_ == threads_.size(); }

  static constexpr std::int64_t kStall_ns = 10'000'000;

  /// So long naps a witness of drives that bridge `bridge_ns`: a stall that begins within its nap
  /// is seen by up to so much too short.
  [[nodiscard]] static constexpr std::int64_t nap_ns(std::int64_t bridge_ns) noexcept {
    constexpr std::int64_t kShortest_ns = 1'000'000, kLongest_ns = 5'000'000;
    return std::clamp(bridge_ns / 10, kShortest_ns, kLongest_ns);
  }

 private:
  void watch(int cpu, const std::stop_token& stop);
  void note(const Stall& late);

  std::int64_t nap_ns_, min_ns_;  ///< stalls of less are not reported one by one
  mutable std::mutex mutex_;
  std::map<int, Histogram> lateness_;  ///< by processor
  std::vector<Stall> stalls_;          ///< the newest kMaxStalls
  std::uint64_t count_ = 0;
  std::int64_t longest_ns_ = 0;
  std::atomic<std::size_t> watched_ = 0;
  std::vector<std::jthread> threads_;
  static constexpr std::size_t kMaxStalls = 1000;
};

}  // namespace meridian::soak
