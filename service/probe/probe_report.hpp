// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/plot/gnuplot.hpp"
#include "service/probe/budgets.hpp"
#include "service/probe/measure.hpp"

namespace meridian::probe {

/// How much a budget that is missed matters.
enum class Weight : std::uint8_t {
  kJudged,      ///< decides
  kTargetHost,  ///< decides where the host is to cut: the budget says "on a target host"
  kReported     ///< never
};

/// One budget held against what was measured.
struct Verdict {
  Budget budget;
  Weight weight = Weight::kJudged;
  int rate_hz = 0;
  bool is_loaded = false;
  double figure = 0, reference = 0;  ///< in the unit of the budget
  [[nodiscard]] bool is_inside() const { return figure <= budget.allowed(reference); }
};

/// Every budget of the table that this measurement can be held against.
[[nodiscard]] std::vector<Verdict> judge(const RateMeasurement& measured,
                                         const std::string& budgets_file = "");

struct ProbeReport {
  std::string host;
  bool is_target = false;  ///< budgets of a target host decide too
  std::vector<RateMeasurement> measurements;
  std::vector<Verdict> verdicts;
  [[nodiscard]] bool is_fit() const;
};

[[nodiscard]] std::string to_text(const ProbeReport& report);
[[nodiscard]] std::string to_json(const ProbeReport& report);
/// Draws the share of samples above each latency, one field for each rate, to a .png or .svg.
[[nodiscard]] std::optional<plot::PlotError> draw(const ProbeReport& report,
                                                  const std::string& file);

/// A distribution of a measurement, as report and picture show it.
struct Shown {
  std::string name;
  Histogram histogram;
  std::optional<std::size_t> stalls;  ///< where samples of at least kStall_ns mean one
};
[[nodiscard]] std::vector<Shown> distributions(const RateMeasurement& measured);

}  // namespace meridian::probe
