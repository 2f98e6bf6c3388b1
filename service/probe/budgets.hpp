// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// The table of budgets, deploy/budgets.toml.
namespace meridian::probe {

struct Budget {
  std::string name, what, statistic, unit, reference, judged;
  double limit = 0;             ///< absolute budgets
  double factor = 0, plus = 0;  ///< relative ones: factor * reference + plus
  double at_least = 0;          ///< budgets from below
  bool is_relative = false;

  /// The largest figure that still passes, given what was measured for the reference.
  [[nodiscard]] double allowed(double reference_figure = 0) const {
    return is_relative ? factor * reference_figure + plus : limit;
  }
};

/// The budget of that name; throws std::runtime_error where the table has none or a row is not
/// whole (exactly one of limit, factor with plus and reference, at_least). Proof:
/// tests/unit/probe/budgets_test.cpp.
[[nodiscard]] Budget load_budget(const std::string& name, const std::string& file = "");

/// "p50 12.3, p99 45.6 us" is written by tests; this is the budget's half of the line: what it is,
/// how much is allowed and how it is judged.
[[nodiscard]] std::string to_text(const Budget& budget, double reference_figure = 0);

}  // namespace meridian::probe
