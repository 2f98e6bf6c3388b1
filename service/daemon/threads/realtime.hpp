// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "service/machine/file/sections/service_file.hpp"
#include "service/transport/convert/messages.hpp"

/// Threads, priorities, processors and memory: what the service asks of the kernel.
/// docs/realtime.md says why.
namespace meridian::interpolator {

/// The service cannot start; the message says why and what to do.
class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Stack of every thread of the service. Small, because locked memory is resident: a cut through
/// the pole, smooth and live, is planned with 160 kB. Sanitizers keep data of their own there.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr std::size_t kStack_bytes = 8 * 1024 * 1024;
#else
inline constexpr std::size_t kStack_bytes = 256 * 1024;
#endif

/// A thread with a name, a small stack and a place in the schedule.
struct ThreadPlan {
  std::string name;  ///< at most 15 characters
  int priority = 0;  ///< FIFO; 0: normal
  bool is_on_realtime_cpu = false;
};

/// What was got of a config::RealtimeConfig, and the way to start threads under it. Lives as long
/// as the service: it holds /dev/cpu_dma_latency.
class Realtime {
 public:
  /// Locks memory, keeps the processors awake, and pins the calling thread off the real-time CPU,
  /// so that threads it starts (Cyclone's too) stay off it. Throws StartError where a right is
  /// missing and the wish is enforced.
  explicit Realtime(const config::RealtimeConfig& wish);
  ~Realtime();
  Realtime(const Realtime&) = delete;
  Realtime& operator=(const Realtime&) = delete;

  [[nodiscard]] dds::RealtimeMode mode() const noexcept {
    return is_enforced() ? dds::RealtimeMode::kEnforced : dds::RealtimeMode::kBestEffort;
  }
  /// Whether threads really get FIFO priorities.
  [[nodiscard]] bool has_priorities() const noexcept { return has_priorities_; }
  /// One sentence for every right that is missing in best effort.
  [[nodiscard]] const std::vector<std::string>& remarks() const noexcept { return remarks_; }
  [[nodiscard]] int cpu() const noexcept { return cpu_; }
  /// The calling thread runs at FIFO `priority` from now on, where priorities are there; threads
  /// that it starts without a plan inherit that.
  void rise_to(int priority) const noexcept;
  [[nodiscard]] const config::RealtimeConfig& wish() const noexcept { return wish_; }

 private:
  friend class Thread;
  [[nodiscard]] bool is_enforced() const noexcept {
    return wish_.mode == config::RealtimeMode::kEnforce;
  }
  void need(bool is_there, const std::string& what, const std::string& remedy);

  config::RealtimeConfig wish_;
  bool has_priorities_ = false;
  int cpu_ = 0;
  cpu_set_t realtime_cpus_, other_cpus_;
  int dma_latency_ = -1;
  std::vector<std::string> remarks_;
};

/// A running thread; join() or the destructor waits for its end.
class Thread {
 public:
  Thread() = default;
  /// Starts `body` as `plan` says; where priorities are missing, as a normal thread. Throws
  /// StartError where the thread cannot be made.
  Thread(const Realtime& realtime, const ThreadPlan& plan, std::function<void()> body);
  ~Thread() { join(); }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  Thread(Thread&& other) noexcept;
  Thread& operator=(Thread&& other) noexcept;

  void join() noexcept;

 private:
  pthread_t thread_{};
  bool is_running_ = false;
};

}  // namespace meridian::interpolator
