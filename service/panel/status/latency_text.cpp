// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/latency_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "service/panel/json_text.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

/// Which budgets a stage of the service has.
struct StageBudget {
  std::string_view stage, budget;
};
constexpr std::array<StageBudget, 8> kStageBudgets{{
    {"wake-up lateness", "cycle_lateness"},
    {"cycle computation", "cycle_computation_p50"},
    {"cycle computation", "cycle_computation_p999"},
    {"cycle computation", "cycle_share"},
    {"publisher's wake", "publisher_wake"},
    {"sent minus due", "setpoint_latency_p99"},
    {"setpoint to feedback", "round_trip_p50"},
    {"setpoint to feedback", "round_trip_p99"},
}};

constexpr int kBinsPerOctave = 4, kOctaves = 19;
constexpr double kFirst_us = 0.256;

[[nodiscard]] double us_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

/// How many values lie in each bin; what is shorter is in the first, what is longer in the last.
[[nodiscard]] json bins_of(const Histogram& histogram) {
  std::array<std::uint64_t, std::size_t{kBinsPerOctave} * kOctaves> bins{};
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) {
    if (histogram.bucket(i) == 0) continue;
    const double end_us = us_of(Histogram::bucket_end_ns(i) + 1);
    const double octaves = std::log2(std::max(end_us / kFirst_us, 1.0));
    const auto bin =
        static_cast<std::size_t>(std::max(0.0, std::ceil(octaves * kBinsPerOctave) - 1));
    bins[std::min(bin, bins.size() - 1)] += histogram.bucket(i);
  }
  return bins;
}

/// The figure of that name, µs; nothing where a histogram does not tell it.
[[nodiscard]] std::optional<double> figure_of(const Histogram& histogram, std::string_view name) {
  if (name == "p50") return us_of(histogram.percentile_ns(0.5));
  if (name == "p99") return us_of(histogram.percentile_ns(0.99));
  if (name == "p99.9") return us_of(histogram.percentile_ns(0.999));
  return std::nullopt;
}

/// What a budget allows, µs; nothing where that is by comparison.
[[nodiscard]] std::optional<double> limit_of(const probe::Budget& budget, std::int64_t cycle_ns) {
  if (budget.bound != probe::Bound::kMax) return std::nullopt;
  if (budget.unit == "us") return budget.limit;
  if (budget.unit == "%") return 1e-2 * budget.limit * us_of(cycle_ns);
  return std::nullopt;
}

[[nodiscard]] json budgets_of(const dds::NamedHistogram& stage, std::int64_t cycle_ns,
                              const std::vector<probe::Budget>& budgets) {
  json out = json::array();
  for (const probe::Budget& budget : budgets) {
    const bool is_its =
        std::any_of(kStageBudgets.begin(), kStageBudgets.end(), [&](const StageBudget& row) {
          return row.stage == stage.name && row.budget == budget.name;
        });
    if (!is_its) continue;
    json one = {{"statistic", budget.statistic}, {"text", probe::bound_text(budget)}};
    const auto limit = limit_of(budget, cycle_ns);
    const auto figure = figure_of(stage.histogram, budget.statistic);
    if (limit && figure) {
      one["limit"] = *limit;
      one["figure"] = *figure;
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

std::vector<probe::Budget> known_budgets() {
  try {
    return probe::load_budgets();
  } catch (const std::exception&) {
    return {};  // a program that was copied by itself: shown without
  }
}

std::string latency_text(const dds::Latency& latency, std::int64_t cycle_ns,
                         const std::vector<probe::Budget>& budgets) {
  json stages = json::array();
  for (const dds::NamedHistogram& stage : latency.histograms) {
    const Histogram& h = stage.histogram;
    stages.push_back({{"name", stage.name},
                      {"count", h.count()},
                      {"p50", us_of(h.percentile_ns(0.5))},
                      {"p99", us_of(h.percentile_ns(0.99))},
                      {"p999", us_of(h.percentile_ns(0.999))},
                      {"max", us_of(h.max_ns())},
                      {"bins", bins_of(h)},
                      {"budgets", budgets_of(stage, cycle_ns, budgets)}});
  }
  return json_text({{"t", "latency"},
                    {"first_us", kFirst_us},
                    {"per_octave", kBinsPerOctave},
                    {"stages", stages}});
}

}  // namespace meridian::panel
