// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace meridian::soak {

/// Which overruns the host accounts for: a ring is full where its reader was kept from its
/// processor, whichever that is. Those within kNear_s of a stall, before it was seen or behind it,
/// are the host's; one stall excuses nothing of the rest of a run.
/// Proof: tests/unit/soak/run_budgets_test.cpp.
class OverrunExcuse {
 public:
  static constexpr double kNear_s = 2;

  /// How many of the overruns that were reported lately are the host's: `overruns` are new,
  /// `has_stall` where a processor came back within the last kNear_s.
  [[nodiscard]] std::uint64_t explain(double now_s, std::uint64_t overruns, bool has_stall) {
    if (overruns > 0) open_.push_back({now_s, overruns});
    std::erase_if(open_, [now_s](const Overruns& one) { return now_s - one.at_s > kNear_s; });
    if (!has_stall) return 0;
    std::uint64_t explained = 0;
    for (const Overruns& one : open_) explained += one.overruns;
    open_.clear();
    return explained;
  }

 private:
  struct Overruns {
    double at_s = 0;
    std::uint64_t overruns = 0;
  };
  std::deque<Overruns> open_;  ///< not explained yet
};

}  // namespace meridian::soak
