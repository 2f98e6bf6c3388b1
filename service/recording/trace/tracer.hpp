// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "service/recording/trace/kept_files.hpp"
#include "service/recording/trace/slow_cycles.hpp"
#include "service/recording/trace/spans.hpp"
#include "service/recording/trace/trace_text.hpp"

namespace meridian::trace {

struct TraceOptions {
  std::filesystem::path folder;  ///< empty: no traces
  SlowLimits limits;
  std::int64_t before_ns = 50'000'000, after_ns = 20'000'000;  ///< around the slow cycle
  /// From the end of one file to the next at least; what is twice as bad need not wait.
  std::int64_t every_ns = 10'000'000'000;
  int max_files = 10;  ///< in the folder; the worst stay
};

/// What every file says of where it comes from.
struct TraceOrigin {
  std::string machine, service_version, host;
};

/// Keeps what the threads did lately and, where a cycle was slow, writes what was around it to a
/// file. A thread of normal priority: what it cannot take in time is lost and counted, nobody
/// waits for it. Proof: tests/unit/daemon/trace_test.cpp.
class Tracer {
 public:
  using Say = std::function<void(const std::string&)>;
  /// Throws std::filesystem::filesystem_error where the folder cannot be made.
  Tracer(TraceOptions options, TraceOrigin origin, Rings& rings, Say say);

  /// Runs until `is_stopping`; then writes what is still to be written.
  void run(const std::atomic<bool>& is_stopping) noexcept;
  /// One look, at `now_ns` of the machine's clock.
  void work(std::int64_t now_ns);

 private:
  void drain(Track track, SpanRing& ring);
  void see(const SlowCycle& slow);
  void forget(std::int64_t now_ns);
  void write();
  [[nodiscard]] bool is_wanted(const SlowCycle& slow) const;

  TraceOptions options_;
  TraceOrigin origin_;
  Rings& rings_;
  Say say_;
  KeptFiles files_;
  SlowCycles slow_cycles_;
  std::array<std::deque<Span>, kTracks> lately_;
  struct Pending {
    SlowCycle worst;
    std::int64_t begin_ns = 0, end_ns = 0;
  };
  std::optional<Pending> pending_;
  std::optional<SlowCycle>
      worst_later_;  ///< the worst behind what is pending, seen before its turn
  struct Written {
    std::int64_t end_ns = 0, severity_ns = 0;
  };
  std::optional<Written> written_;  ///< newest file
};

/// A tracer; nullptr where its folder cannot be made or read, which `complain` hears: traces are no
/// reason for a machine to stand.
[[nodiscard]] std::unique_ptr<Tracer> make_tracer(TraceOptions options, TraceOrigin origin,
                                                  Rings& rings, Tracer::Say say,
                                                  const Tracer::Say& complain);

}  // namespace meridian::trace
