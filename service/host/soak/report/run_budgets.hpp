// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "service/host/probe/budgets.hpp"

namespace meridian::soak {

struct SoakReport;

/// Budgets of a whole run, from the table of budgets.
struct RunBudgets {
  probe::Budget page_faults, periods_lost, overruns, switches;
  /// Of a histogram: a percentile of the last quarter of the run against the first.
  struct Drift {
    std::string histogram;
    double share = 0;
    probe::Budget budget;
  };
  std::vector<Drift> drifts;
};
/// Throws as probe::load_budget().
[[nodiscard]] RunBudgets load_run_budgets();

/// What came of one budget.
struct CheckResult {
  enum class Verdict : std::uint8_t { kKept, kBroken, kNotChecked };
  probe::Budget budget;
  double figure = 0, reference = 0;
  Verdict verdict = Verdict::kNotChecked;
  std::string why;  ///< not checked: the reason
};

/// Checks a run by its budgets: page faults of cycle and publisher after Ready, periods lost and
/// overruns that no stall of the host explains, switches of the cycle, drift of latencies. What
/// nobody can know here is not checked and says why: rights that were missing, too few samples, a
/// host that stalled or drifted itself, quarters of different work. Proof:
/// tests/unit/soak/run_budgets_test.cpp.
[[nodiscard]] std::vector<CheckResult> check_run(const SoakReport& report);

/// A line each, and an array of JSON.
[[nodiscard]] std::string to_text(const std::vector<CheckResult>& results);
[[nodiscard]] std::string to_json(const std::vector<CheckResult>& results);

/// So many samples a quarter must have, and a life cycles, to be checked: a minute at 1 kHz.
inline constexpr std::uint64_t kMinSamples = 60'000;

/// The witness's histogram among the slices of a run.
inline constexpr const char* kBareThread = "bare thread";
/// There too: 1 for each status of a machine that moved in a program, 0 for every other.
inline constexpr const char* kCutting = "cutting";

}  // namespace meridian::soak
