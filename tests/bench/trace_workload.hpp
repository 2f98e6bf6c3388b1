// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/recording/trace/spans.hpp"

namespace meridian::bench {

/// What tracing costs a cycle and its publisher where it is off: the questions of the cycle whether
/// it is on, and the publisher's span. The pen is read again each time, as in a thread that has
/// done other things in between.
inline std::uint64_t run_trace_off(int count) {
  struct Thread {
    trace::SpanWriter cycle{nullptr}, publisher{nullptr};
  } thread;
  std::uint64_t sum = 1;
  for (int i = 0; i < count; ++i) {
    const Thread* seen = &thread;
    asm volatile("" : "+r"(seen) : : "memory");
    if (seen->cycle.is_on()) ++sum;
    asm volatile("" : "+r"(seen) : : "memory");
    if (seen->cycle.is_on()) ++sum;
    asm volatile("" : "+r"(seen) : : "memory");
    trace::SpanWriter publisher = seen->publisher;
    publisher.write(trace::Doing::kWrite, i, i + 1, sum);
  }
  return sum;
}

}  // namespace meridian::bench
