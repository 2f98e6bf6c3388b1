// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/analysis/plot/gnuplot.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/host/probe/doctor/doctor.hpp"
#include "service/host/probe/run/measure.hpp"
#include "service/machine/file/sections/service_file.hpp"

namespace meridian::probe {

/// How much a budget that is missed matters.
enum class Weight : std::uint8_t {
  kChecked,     ///< decides
  kTargetHost,  ///< decides where the host is to cut: the budget says "on a target host"
  kReported     ///< never
};

/// One budget held against what was measured.
struct Verdict {
  Budget budget;
  Weight weight = Weight::kChecked;
  int rate_hz = 0;
  bool is_loaded = false;
  double figure = 0, reference = 0;  ///< in the unit of the budget
  /// Of figure and reference, of whichever there are fewer: what was measured, and how many samples
  /// there must be before they say anything (row samples_taken of the table).
  std::uint64_t samples = 0, wanted = 0;
  [[nodiscard]] bool is_measured() const { return samples >= wanted; }
  [[nodiscard]] bool is_inside() const {
    return is_measured() && budget.is_kept(figure, reference);
  }
};

/// Every budget of the table that this measurement can be held against.
[[nodiscard]] std::vector<Verdict> check(const RateMeasurement& measured,
                                         const std::string& budgets_file = "");

/// Rights to real time that this process has not, of those that a service with these wishes needs:
/// it would refuse to start where it enforces them.
[[nodiscard]] std::vector<std::string> missing_rights(const Rights& rights,
                                                      const config::RealtimeConfig& wishes);

struct ProbeReport {
  std::string host;
  bool is_target = false;  ///< budgets of a target host decide too, and so do rights
  std::vector<RateMeasurement> measurements;
  std::vector<Verdict> verdicts;
  int cpu = 0;                              ///< of the cycle and the bare programs
  std::vector<std::string> missing_rights;  ///< bare programs and service ran without them
  std::string broken_off;  ///< why there are not all measurements; empty: there are

  /// Takes a measurement and its verdicts.
  void add(const RateMeasurement& measured);
  /// Something was measured, all of it, and nothing that decides is wrong or unknown.
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
