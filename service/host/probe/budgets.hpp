// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// The table of budgets, deploy/budgets.toml.
namespace meridian::probe {

/// From which side a budget bounds its figure.
enum class Bound : std::uint8_t {
  kMax,             ///< limit: the figure must not exceed it
  kMaxByReference,  ///< factor, plus: nor factor * reference + plus
  kMin              ///< at_least: the figure must not fall below it
};

struct Budget {
  std::string name, what, statistic, unit, reference, checked;
  Bound bound = Bound::kMax;
  double limit = 0;
  double factor = 0, plus = 0;
  double at_least = 0;

  /// The figure that only just passes, given what was measured for the reference: the largest one,
  /// or of a budget from below the smallest.
  [[nodiscard]] double allowed(double reference_figure = 0) const;
  /// Whether a figure passes. What is not a number does not.
  [[nodiscard]] bool is_kept(double figure, double reference_figure = 0) const;
};

/// The budget of that name; throws std::runtime_error where the table has none or a row is not
/// whole (exactly one of limit, factor with plus and reference, at_least). Proof:
/// tests/unit/probe/budgets_test.cpp.
[[nodiscard]] Budget load_budget(const std::string& name, const std::string& file = "");

/// The whole table, by name; throws as load_budget().
[[nodiscard]] std::vector<Budget> load_budgets(const std::string& file = "");

/// The bound as tables of the docs have it: "<= 50 %", "<= 1.5 x bare thread + 20 us",
/// ">= 20000 blocks/s".
[[nodiscard]] std::string bound_text(const Budget& budget);

/// "p50 12.3, p99 45.6 us" is written by tests; this is the budget's half of the line: what it is,
/// how much is allowed and how it is checked.
[[nodiscard]] std::string to_text(const Budget& budget, double reference_figure = 0);

}  // namespace meridian::probe
