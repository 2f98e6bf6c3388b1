// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "meridian/cycle/histogram.hpp"

namespace meridian::soak {

/// Which of the periods that a cycle lost its host accounts for. A witness of highest priority on
/// the cycle's processor (HostWatch) naps and is late where the processor was away. A wake that is
/// late by a period or more accounts for the periods that its lateness touches, and for those of
/// half a nap: a stall that it sees began up to a nap before it was due. Whoever is less late
/// accounts for none.
/// Proof: tests/unit/soak/run_budgets_test.cpp.
class HostCredit {
 public:
  HostCredit(std::int64_t period_ns, std::int64_t nap_ns) noexcept
      : period_ns_(period_ns), nap_ns_(nap_ns) {}

  /// By how much the witness woke too late since the last call.
  void add(double now_s, const Histogram& lateness) {
    std::uint64_t periods = 0;
    for (std::size_t i = 0; i < Histogram::kBuckets; ++i) {
      const std::int64_t late_ns = Histogram::bucket_end_ns(i);
      if (lateness.bucket(i) == 0 || late_ns < period_ns_) continue;
      const auto each = static_cast<std::uint64_t>((late_ns + nap_ns_ / 2) / period_ns_ + 1);
      periods += lateness.bucket(i) * each;
    }
    if (periods > 0) credits_.push_back({now_s, periods});
  }

  /// How many of `lost` periods were the host's; that much of what it did lately is used up.
  [[nodiscard]] std::uint64_t explain(double now_s, std::uint64_t lost) {
    std::erase_if(credits_, [now_s](const Credit& one) { return now_s - one.at_s > kKept_s; });
    std::uint64_t explained = 0;
    while (explained < lost && !credits_.empty()) {
      const std::uint64_t taken = std::min(lost - explained, credits_.front().periods);
      explained += taken;
      credits_.front().periods -= taken;
      if (credits_.front().periods == 0) credits_.pop_front();
    }
    return explained;
  }

 private:
  static constexpr double kKept_s = 10;  ///< the witness sees some stalls and misses others
  struct Credit {
    double at_s = 0;
    std::uint64_t periods = 0;
  };
  std::int64_t period_ns_, nap_ns_;
  std::deque<Credit> credits_;
};

}  // namespace meridian::soak
