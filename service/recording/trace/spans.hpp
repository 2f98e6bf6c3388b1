// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "meridian/cycle/spsc_ring.hpp"

/// What the threads of the service did when, for the question why a cycle was slow.
namespace meridian::trace {

/// What a thread did, the threads one after the other. docs/realtime.md says what each means.
enum class Doing : std::uint8_t {
  kWakeUp,       ///< cycle: due until awake, periods that nobody executed included; arg: cycle
  kGather,       ///< cycle: inputs; arg: cycle
  kStep,         ///< cycle: the step; arg: cycle
  kWakeOther,    ///< cycle: handing the setpoint over, waking the publisher; arg: cycle
  kShow,         ///< cycle: views, records, events; arg: cycle
  kWrite,        ///< publisher: a setpoint into DDS; arg: cycle
  kPlan,         ///< planner: a block; arg: its sequence number
  kWaitForRoom,  ///< planner: a block for which the motion has no room yet; arg: its sequence
                 ///< number
  kAdvance,      ///< planner: looks at what it has while no block is there
  kTakeBlocks,   ///< intake: checks batches and queues them; arg: blocks queued, ever
  kFeedback      ///< receive thread: what the drives reported; arg: newest cycle that they saw
};
inline constexpr std::size_t kDoings = 11;

/// A thread did something. RT: plain data.
struct Span {
  std::int64_t begin_ns = 0;  ///< machine's clock
  std::uint64_t arg = 0;
  std::int32_t took_ns = 0;
  Doing doing = Doing::kStep;
};

/// The spans of one thread on their way to who writes traces.
struct SpanRing {
  SpscRing<Span, 8192> spans;
  std::atomic<std::uint64_t> lost{0};  ///< for which there was no room
};

/// One ring for each thread that is traced.
struct Rings {
  SpanRing cycle, publisher, planner, intake, receive;
};

/// A thread's pen: tracing off, every call is one branch. RT: cycle.
class SpanWriter {
 public:
  explicit SpanWriter(SpanRing* ring) noexcept : ring_(ring) {}

  /// Whether spans are wanted: who has to take a time for one alone asks first.
  [[nodiscard]] bool is_on() const noexcept { return ring_ != nullptr; }

  /// Nobody sees it before publish().
  void stage(Doing doing, std::int64_t begin_ns, std::int64_t end_ns, std::uint64_t arg) noexcept {
    if (ring_ == nullptr) return;
    constexpr std::int64_t kMax_ns = std::numeric_limits<std::int32_t>::max();
    const auto took_ns =
        static_cast<std::int32_t>(std::clamp<std::int64_t>(end_ns - begin_ns, 0, kMax_ns));
    if (ring_->spans.stage({begin_ns, arg, took_ns, doing})) return;
    ring_->lost.fetch_add(1, std::memory_order_relaxed);
  }
  void publish() noexcept {
    if (ring_ != nullptr) ring_->spans.publish();
  }
  void write(Doing doing, std::int64_t begin_ns, std::int64_t end_ns, std::uint64_t arg) noexcept {
    stage(doing, begin_ns, end_ns, arg);
    publish();
  }

 private:
  SpanRing* ring_;
};

}  // namespace meridian::trace
