// SPDX-License-Identifier: Apache-2.0
#include "service/probe/probe_report.hpp"

#include <algorithm>

#include "service/text/printed.hpp"

namespace meridian::probe {
namespace {

using text::append;
using text::Count;
using text::json_quoted;

constexpr double kUs = 1e-3;

[[nodiscard]] double percentile_us(const Histogram& histogram, double share) {
  return static_cast<double>(histogram.percentile_ns(share)) * kUs;
}

[[nodiscard]] Weight weight_of(const Budget& budget) {
  if (budget.judged.starts_with("reported")) return Weight::kReported;
  return budget.judged.starts_with("on a target host") ? Weight::kTargetHost : Weight::kJudged;
}

[[nodiscard]] double percent(std::uint64_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

[[nodiscard]] std::string place(int rate_hz, bool is_loaded) {
  return std::to_string(rate_hz) + " Hz" + (is_loaded ? " under load" : "");
}

[[nodiscard]] const char* word(const Verdict& verdict) {
  if (verdict.is_inside()) return "inside";
  return verdict.weight == Weight::kJudged ? "OUTSIDE" : "outside";
}

[[nodiscard]] const char* word(Weight weight) {
  constexpr const char* kWeights[] = {"judged", "target host", "reported"};
  return kWeights[static_cast<std::size_t>(weight)];
}

void append_measurement(std::string& out, const RateMeasurement& m) {
  append(out, "\n%s; latency, us %17s %9s %9s %9s %9s %8s\n", place(m.rate_hz, m.is_loaded).c_str(),
         "samples", "p50", "p99", "p99.9", "max", "stalls");
  for (const Shown& one : distributions(m)) {
    append(out, "  %-30s %9llu %9.1f %9.1f %9.1f %9.1f", one.name.c_str(),
           Count{one.histogram.count()}, percentile_us(one.histogram, 0.5),
           percentile_us(one.histogram, 0.99), percentile_us(one.histogram, 0.999),
           static_cast<double>(one.histogram.max_ns()) * kUs);
    if (one.stalls) append(out, " %8zu", *one.stalls);
    out += '\n';
  }
  append(out,
         "  periods lost: service %llu, bare thread %llu; setpoints not seen %llu of %llu; "
         "processor time that the host took away: %.0f ms\n",
         Count{m.lost_periods}, Count{m.bare_lost_periods}, Count{m.unseen}, Count{m.sent},
         m.stolen_ms);
  if (m.broken_off.empty()) return;
  out += "  NO PROGRAM CAN BE CUT HERE: " + m.broken_off;
  if (out.back() != '\n') out += '\n';
}

void append_distribution(std::string& out, const Shown& one) {
  const Histogram& h = one.histogram;
  append(out,
         "\n    {\"name\": %s, \"samples\": %llu, \"p50_us\": %.3f, \"p99_us\": %.3f, "
         "\"p999_us\": %.3f, \"max_us\": %.3f",
         json_quoted(one.name).c_str(), Count{h.count()}, percentile_us(h, 0.5),
         percentile_us(h, 0.99), percentile_us(h, 0.999), static_cast<double>(h.max_ns()) * kUs);
  if (one.stalls) append(out, ", \"stalls\": %zu", *one.stalls);
  out += "}";
}

}  // namespace

std::vector<Shown> distributions(const RateMeasurement& m) {
  std::vector<Shown> shown;
  for (const Turns* turns : {&m.lateness, &m.bare_wake}) {
    shown.push_back({turns->name(), turns->histogram(), turns->stalls()});
  }
  if (m.cyclictest) shown.push_back({"cyclictest", *m.cyclictest, std::nullopt});
  for (const Turns* turns : {&m.one_way, &m.bare_one_way}) {
    shown.push_back({turns->name(), turns->histogram(), turns->stalls()});
  }
  shown.push_back({"service, round trip", m.round_trip, std::nullopt});
  for (const Turns* turns : {&m.bare_round_trip, &m.computation}) {
    shown.push_back({turns->name(), turns->histogram(), turns->stalls()});
  }
  shown.push_back({"service, publisher's wake", m.wake, std::nullopt});
  return shown;
}

std::vector<Verdict> judge(const RateMeasurement& m, const std::string& budgets_file) {
  std::vector<Verdict> verdicts;
  const auto hold = [&](const char* name, double figure, double reference = 0) {
    const Budget budget = load_budget(name, budgets_file);
    verdicts.push_back({budget, weight_of(budget), m.rate_hz, m.is_loaded, figure, reference});
  };
  const Figures computation = m.computation.all();
  const double period_us = 1e6 / m.rate_hz;
  hold("cycle_lateness", m.lateness.median_p99_us(), m.bare_wake.median_p99_us());
  hold("cycle_lateness_target", m.lateness.median_p99_us(), m.bare_wake.median_p99_us());
  hold("periods_lost", percent(m.lost_periods, m.lateness.all().samples),
       percent(m.bare_lost_periods, m.bare_wake.all().samples));
  if (computation.samples > 0) {
    hold("cycle_share", 100 * computation.p999_us / period_us);
    hold("cycle_computation_p50", computation.p50_us);
    hold("cycle_computation_p999", computation.p999_us);
    hold("publisher_wake", percentile_us(m.wake, 0.5));
  }
  hold("setpoint_latency_p50", m.one_way.median_p50_us(), m.bare_one_way.median_p50_us());
  hold("setpoint_latency_p99", m.one_way.median_p99_us(), m.bare_one_way.median_p99_us());
  hold("round_trip_p50", percentile_us(m.round_trip, 0.5), m.bare_round_trip.all().p50_us);
  hold("round_trip_p99", percentile_us(m.round_trip, 0.99), m.bare_round_trip.all().p99_us);
  return verdicts;
}

bool ProbeReport::is_fit() const {
  const auto is_cut = [](const RateMeasurement& m) { return m.broken_off.empty(); };
  if (!std::all_of(measurements.begin(), measurements.end(), is_cut)) return false;
  return std::all_of(verdicts.begin(), verdicts.end(), [this](const Verdict& verdict) {
    const bool is_counted =
        verdict.weight == Weight::kJudged || (is_target && verdict.weight == Weight::kTargetHost);
    return verdict.is_inside() || !is_counted;
  });
}

std::string to_text(const ProbeReport& report) {
  std::string out = report.host + "\n";
  for (const RateMeasurement& m : report.measurements) {
    append_measurement(out, m);
    for (const Verdict& verdict : report.verdicts) {
      if (verdict.rate_hz != m.rate_hz || verdict.is_loaded != m.is_loaded) continue;
      append(out, "  %-7s %-24s %8.1f, allowed %8.1f %-3s (%s)\n", word(verdict),
             verdict.budget.name.c_str(), verdict.figure, verdict.budget.allowed(verdict.reference),
             verdict.budget.unit.c_str(), word(verdict.weight));
    }
  }
  append(out, "\n%s: %s\n", report.is_fit() ? "FIT" : "NOT FIT",
         report.is_target ? "budgets of a target host counted"
                          : "judged in comparison with bare programs of the same run");
  if (!report.is_fit()) {
    out +=
        "what is wrong with the host: meridian doctor; what a slow cycle waited for: meridiand "
        "--trace FOLDER\n";
  }
  return out;
}

std::string to_json(const ProbeReport& report) {
  std::string out = "{\"host\": " + json_quoted(report.host) +
                    ", \"fit\": " + (report.is_fit() ? "true" : "false") +
                    ",\n \"measurements\": [";
  const char* separator = "\n  ";
  for (const RateMeasurement& m : report.measurements) {
    append(out,
           "%s{\"rate_hz\": %d, \"loaded\": %s, \"periods_lost\": %llu, \"bare_periods_lost\": "
           "%llu, \"setpoints\": %llu, \"setpoints_unseen\": %llu, \"stolen_ms\": %.1f, "
           "\"broken_off\": %s, \"distributions\": [",
           separator, m.rate_hz, m.is_loaded ? "true" : "false", Count{m.lost_periods},
           Count{m.bare_lost_periods}, Count{m.sent}, Count{m.unseen}, m.stolen_ms,
           json_quoted(m.broken_off).c_str());
    const char* comma = "";
    for (const Shown& one : distributions(m)) {
      out += comma;
      append_distribution(out, one);
      comma = ",";
    }
    out += "]}";
    separator = ",\n  ";
  }
  out += "],\n \"budgets\": [";
  separator = "\n  ";
  for (const Verdict& verdict : report.verdicts) {
    append(out,
           "%s{\"budget\": %s, \"rate_hz\": %d, \"loaded\": %s, \"figure\": %.4g, \"allowed\": "
           "%.4g, \"unit\": %s, \"inside\": %s, \"weight\": %s}",
           separator, json_quoted(verdict.budget.name).c_str(), verdict.rate_hz,
           verdict.is_loaded ? "true" : "false", verdict.figure,
           verdict.budget.allowed(verdict.reference), json_quoted(verdict.budget.unit).c_str(),
           verdict.is_inside() ? "true" : "false", json_quoted(word(verdict.weight)).c_str());
    separator = ",\n  ";
  }
  return out + "]}\n";
}

}  // namespace meridian::probe
