// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/probe_report.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

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
  if (budget.checked.starts_with("reported")) return Weight::kReported;
  return budget.checked.starts_with("on a target host") ? Weight::kTargetHost : Weight::kChecked;
}

/// Samples of one distribution, and how many the time was for.
struct Samples {
  std::uint64_t taken = 0, of = 0;
};

/// Fewer samples than this have no such percentile.
[[nodiscard]] std::uint64_t min_for(const std::string& statistic) {
  return statistic.find("p99.9") != std::string::npos ? 1000 : 100;
}

[[nodiscard]] std::string condition(int rate_hz, bool is_loaded) {
  return std::to_string(rate_hz) + " Hz" + (is_loaded ? " under load" : "");
}

[[nodiscard]] const char* word(const Verdict& verdict) {
  if (!verdict.is_measured()) return "UNKNOWN";
  if (verdict.is_inside()) return "inside";
  return verdict.weight == Weight::kChecked ? "OUTSIDE" : "outside";
}

[[nodiscard]] const char* word(Weight weight) {
  constexpr const char* kWeights[] = {"checked", "target host", "reported"};
  return kWeights[static_cast<std::size_t>(weight)];
}

[[nodiscard]] std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void append_measurement(std::string& out, const RateMeasurement& m) {
  append(out, "\n%s; latency, us %17s %9s %9s %9s %9s %8s\n",
         condition(m.rate_hz, m.is_loaded).c_str(), "samples", "p50", "p99", "p99.9", "max",
         "stalls");
  for (const Shown& one : distributions(m)) {
    append(out, "  %-30s %9llu %9.1f %9.1f %9.1f %9.1f", one.name.c_str(),
           Count{one.histogram.count()}, percentile_us(one.histogram, 0.5),
           percentile_us(one.histogram, 0.99), percentile_us(one.histogram, 0.999),
           static_cast<double>(one.histogram.max_ns()) * kUs);
    if (one.stalls) append(out, " %8zu", *one.stalls);
    out += '\n';
  }
  const auto missing = [&out](const char* what, const Missing& one) {
    append(out, "%s %llu of %llu", what, Count{one.missing}, Count{one.of});
  };
  missing("  periods lost: in Off", m.lost);
  missing(", cutting", m.cutting_lost);
  missing(", bare thread", m.bare_lost);
  missing("\n  not seen by the drives: in Off", m.unseen);
  missing(", cutting", m.cutting_unseen);
  missing(", bare ping", m.bare_unseen);
  append(out, "\n  cycles not timed: %llu; processor time that the host took away: %.0f ms\n",
         Count{m.untimed}, m.stolen_ms);
  if (m.is_interrupted) out += "  INTERRUPTED: this is what there was until then\n";
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
  shown.push_back({"Off: round trip", m.round_trip, std::nullopt});
  for (const Turns* turns :
       {&m.bare_round_trip, &m.cutting_lateness, &m.cutting_one_way, &m.computation}) {
    shown.push_back({turns->name(), turns->histogram(), turns->stalls()});
  }
  shown.push_back({"cutting: publisher's wake", m.wake, std::nullopt});
  return shown;
}

std::vector<Verdict> check(const RateMeasurement& m, const std::string& budgets_file) {
  const double wanted_share = load_budget("samples_taken", budgets_file).at_least / 100;
  std::vector<Verdict> verdicts;
  const auto hold = [&](const char* name, double figure, double reference,
                        std::initializer_list<Samples> all) {
    const Budget budget = load_budget(name, budgets_file);
    Verdict verdict{budget, weight_of(budget), m.rate_hz, m.is_loaded, figure, reference};
    for (const Samples& one : all) {
      const double of = static_cast<double>(std::max(one.of, min_for(budget.statistic)));
      const auto wanted = static_cast<std::uint64_t>(std::ceil(wanted_share * of));
      if (verdict.wanted == 0 || one.taken * verdict.wanted < verdict.samples * wanted) {
        verdict.samples = one.taken;
        verdict.wanted = wanted;
      }
    }
    verdicts.push_back(verdict);
  };
  const Samples late{m.lateness.samples(), m.periods}, bare{m.bare_wake.samples(), m.periods};
  const Samples cutting_late{m.cutting_lateness.samples(), m.cutting_lost.of};
  const Samples sent{m.one_way.samples(), m.periods}, pings{m.bare_one_way.samples(), m.periods};
  const Samples cutting_sent{m.cutting_one_way.samples(), m.cutting_lost.of};
  const Samples computed{m.computation.samples(), m.moving};
  const Samples back{m.round_trip.count(), m.periods};
  const Samples bare_back{m.bare_round_trip.samples(), m.periods};
  const Figures computation = m.computation.all();
  const double period_us = 1e6 / m.rate_hz, bare_p99_us = m.bare_wake.median_p99_us();

  hold("cycle_lateness", m.lateness.median_p99_us(), bare_p99_us, {late, bare});
  hold("cycle_lateness_target", m.lateness.median_p99_us(), bare_p99_us, {late, bare});
  hold("cutting_lateness", m.cutting_lateness.median_p99_us(), bare_p99_us, {cutting_late, bare});
  hold("turns_taken", static_cast<double>(m.lateness.count()), 0, {});
  hold("periods_lost", m.lost.percent(), m.bare_lost.percent(),
       {{m.lost.of, m.periods}, {m.bare_lost.of, m.periods}});
  hold("cutting_periods_lost", m.cutting_lost.percent(), m.bare_lost.percent(),
       {{m.cutting_lost.of, m.moving}, {m.bare_lost.of, m.periods}});
  hold("cycle_share", 100 * computation.p999_us / period_us, 0, {computed});
  hold("cycle_computation_p50", computation.p50_us, 0, {computed});
  hold("cycle_computation_p999", computation.p999_us, 0, {computed});
  hold("publisher_wake", percentile_us(m.wake, 0.5), 0, {{m.wake.count(), m.moving}});
  hold("setpoints_unseen", m.unseen.percent(), m.bare_unseen.percent(),
       {{m.unseen.of, m.periods - m.lost.missing}, {m.bare_unseen.of, m.periods}});
  hold("cutting_setpoints_unseen", m.cutting_unseen.percent(), m.bare_unseen.percent(),
       {{m.cutting_unseen.of, m.moving}, {m.bare_unseen.of, m.periods}});
  hold("setpoint_latency_p50", m.one_way.median_p50_us(), m.bare_one_way.median_p50_us(),
       {sent, pings});
  hold("setpoint_latency_p99", m.one_way.median_p99_us(), m.bare_one_way.median_p99_us(),
       {sent, pings});
  hold("cutting_setpoint_latency_p50", m.cutting_one_way.median_p50_us(),
       m.bare_one_way.median_p50_us(), {cutting_sent, pings});
  hold("cutting_setpoint_latency_p99", m.cutting_one_way.median_p99_us(),
       m.bare_one_way.median_p99_us(), {cutting_sent, pings});
  hold("round_trip_p50", percentile_us(m.round_trip, 0.5), m.bare_round_trip.all().p50_us,
       {back, bare_back});
  hold("round_trip_p99", percentile_us(m.round_trip, 0.99), m.bare_round_trip.all().p99_us,
       {back, bare_back});
  return verdicts;
}

std::vector<std::string> missing_rights(const Rights& rights,
                                        const config::RealtimeConfig& wishes) {
  std::vector<std::string> missing;
  if (!rights.has_priority) missing.emplace_back("real-time priority");
  if (wishes.lock_memory && !rights.has_locked_memory) missing.emplace_back("locked memory");
  if (wishes.hold_dma_latency && !rights.has_dma_latency) {
    missing.emplace_back("/dev/cpu_dma_latency");
  }
  return missing;
}

void ProbeReport::add(const RateMeasurement& measured) {
  const std::vector<Verdict> checked = check(measured);
  measurements.push_back(measured);
  verdicts.insert(verdicts.end(), checked.begin(), checked.end());
}

bool ProbeReport::is_fit() const {
  if (measurements.empty() || verdicts.empty() || !broken_off.empty()) return false;
  if (is_target && !missing_rights.empty()) return false;
  const auto is_whole = [](const RateMeasurement& m) {
    return m.broken_off.empty() && !m.is_interrupted;
  };
  if (!std::all_of(measurements.begin(), measurements.end(), is_whole)) return false;
  return std::all_of(verdicts.begin(), verdicts.end(), [this](const Verdict& verdict) {
    const bool is_counted =
        verdict.weight == Weight::kChecked || (is_target && verdict.weight == Weight::kTargetHost);
    return verdict.is_inside() || !is_counted;
  });
}

std::string to_text(const ProbeReport& report) {
  std::string out = report.host + "; cycle on processor " + std::to_string(report.cpu) + "\n";
  if (const std::string missing = listed(report.missing_rights); !missing.empty()) {
    out += "NO REAL TIME: without " + missing +
           "; a service in mode \"enforce\" refuses to start here, and what follows was measured "
           "without, the bare programs too\n";
  }
  for (const RateMeasurement& m : report.measurements) {
    append_measurement(out, m);
    for (const Verdict& verdict : report.verdicts) {
      if (verdict.rate_hz != m.rate_hz || verdict.is_loaded != m.is_loaded) continue;
      append(out, "  %-7s %-28s %8.2f, allowed %8.2f %-3s (%s)", word(verdict),
             verdict.budget.name.c_str(), verdict.figure, verdict.budget.allowed(verdict.reference),
             verdict.budget.unit.c_str(), word(verdict.weight));
      if (!verdict.is_measured()) {
        append(out, ": %llu samples, at least %llu wanted", Count{verdict.samples},
               Count{verdict.wanted});
      }
      out += '\n';
    }
  }
  if (!report.broken_off.empty()) out += "\nBROKEN OFF: " + report.broken_off + "\n";
  append(out, "\n%s: %s\n", report.is_fit() ? "FIT" : "NOT FIT",
         report.is_target ? "budgets of a target host counted"
                          : "checked in comparison with bare programs of the same run");
  if (!report.is_fit()) {
    out +=
        "what is wrong with the host: meridian doctor; what a slow cycle waited for: meridiand "
        "--trace FOLDER\n";
  }
  return out;
}

std::string to_json(const ProbeReport& report) {
  std::string out =
      "{\"host\": " + json_quoted(report.host) + ", \"processor\": " + std::to_string(report.cpu) +
      ", \"fit\": " + (report.is_fit() ? "true" : "false") +
      ", \"target\": " + (report.is_target ? "true" : "false") +
      ", \"missing_rights\": " + json_quoted(listed(report.missing_rights)) +
      ", \"broken_off\": " + json_quoted(report.broken_off) + ",\n \"measurements\": [";
  const char* separator = "\n  ";
  for (const RateMeasurement& m : report.measurements) {
    append(out, "%s{\"rate_hz\": %d, \"loaded\": %s, \"interrupted\": %s", separator, m.rate_hz,
           m.is_loaded ? "true" : "false", m.is_interrupted ? "true" : "false");
    const auto missing = [&out](const char* what, const Missing& one) {
      append(out, ", \"%s\": {\"missing\": %llu, \"of\": %llu}", what, Count{one.missing},
             Count{one.of});
    };
    missing("periods_lost", m.lost);
    missing("cutting_periods_lost", m.cutting_lost);
    missing("bare_periods_lost", m.bare_lost);
    missing("setpoints_unseen", m.unseen);
    missing("cutting_setpoints_unseen", m.cutting_unseen);
    missing("bare_pings_unseen", m.bare_unseen);
    append(out, ", \"cycles_not_timed\": %llu, \"stolen_ms\": %.1f, \"broken_off\": %s, ",
           Count{m.untimed}, m.stolen_ms, json_quoted(m.broken_off).c_str());
    out += "\"distributions\": [";
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
           "%.4g, \"unit\": %s, \"inside\": %s, \"samples\": %llu, \"samples_wanted\": %llu, "
           "\"weight\": %s}",
           separator, json_quoted(verdict.budget.name).c_str(), verdict.rate_hz,
           verdict.is_loaded ? "true" : "false", verdict.figure,
           verdict.budget.allowed(verdict.reference), json_quoted(verdict.budget.unit).c_str(),
           verdict.is_inside() ? "true" : "false", Count{verdict.samples}, Count{verdict.wanted},
           json_quoted(word(verdict.weight)).c_str());
    separator = ",\n  ";
  }
  return out + "]}\n";
}

}  // namespace meridian::probe
