// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "service/recording/trace/spans.hpp"

namespace meridian::trace {

/// When a cycle counts as slow.
struct SlowLimits {
  std::int64_t late_ns = 500'000;         ///< wake-up minus due, lost periods included
  std::int64_t computation_ns = 500'000;  ///< inputs and step
};

/// A cycle that was slow.
struct SlowCycle {
  std::uint64_t cycle = 0;
  std::int64_t due_ns = 0, end_ns = 0;  ///< due until handed over
  std::int64_t late_ns = 0, computation_ns = 0;
  /// How bad it was: the longer of the two.
  [[nodiscard]] std::int64_t severity_ns() const noexcept {
    return late_ns > computation_ns ? late_ns : computation_ns;
  }
};

/// Puts the spans of the cycle thread together again and says which cycles were slow. Proof:
/// tests/unit/daemon/trace_test.cpp.
class SlowCycles {
 public:
  explicit SlowCycles(const SlowLimits& limits) noexcept : limits_(limits) {}

  /// Every span of the cycle thread in its order; a slow cycle where it was the last of one.
  [[nodiscard]] std::optional<SlowCycle> see(const Span& span) noexcept {
    const std::int64_t end_ns = span.begin_ns + span.took_ns;
    if (span.doing == Doing::kWakeUp) {
      now_ = {span.arg, span.begin_ns, end_ns, span.took_ns, 0};
    } else if (span.arg == now_.cycle) {
      const bool is_computed = span.doing == Doing::kGather || span.doing == Doing::kStep;
      if (is_computed) now_.computation_ns += span.took_ns;
      now_.end_ns = end_ns;
    }
    const bool is_slow =
        now_.late_ns > limits_.late_ns || now_.computation_ns > limits_.computation_ns;
    if (span.doing != Doing::kWakeOther || span.arg != now_.cycle || !is_slow) return std::nullopt;
    return now_;
  }

 private:
  SlowLimits limits_;
  SlowCycle now_;
};

}  // namespace meridian::trace
