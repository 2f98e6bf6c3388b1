// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace meridian::soak {

/// Sees when the host takes processors away: a thread on each of them, above every other of real
/// time, naps and notes by how much it woke too late. Nothing but the kernel or what is below it
/// keeps such a thread waiting for milliseconds. Without the right to that class it sees nothing.
/// Proof: tests/unit/soak/host_watch_test.cpp.
class HostWatch {
 public:
  HostWatch();
  ~HostWatch();
  HostWatch(const HostWatch&) = delete;
  HostWatch& operator=(const HostWatch&) = delete;

  /// How long the processor that was away for longest was away in the last `last_s`, s. Stalls that
  /// follow one another at once are one.
  [[nodiscard]] double away_s(double last_s) const;
  /// Over all of its life: stalls of at least kStall_ns, and the longest, s.
  [[nodiscard]] std::uint64_t stalls() const;
  [[nodiscard]] double longest_s() const;

  /// Whether every processor is watched.
  [[nodiscard]] bool is_watching() const noexcept { return watched_ == threads_.size(); }

  static constexpr std::int64_t kStall_ns = 10'000'000;

 private:
  struct Stall {
    std::int64_t end_ns, length_ns;
    int cpu;
  };

  void watch(int cpu, const std::stop_token& stop);
  void note(const Stall& stall);

  mutable std::mutex mutex_;
  std::vector<Stall> stalls_;  ///< the newest kMostStalls
  std::uint64_t count_ = 0;
  std::int64_t longest_ns_ = 0;
  std::atomic<std::size_t> watched_ = 0;
  std::vector<std::jthread> threads_;
  static constexpr std::size_t kMostStalls = 1000;
};

}  // namespace meridian::soak
