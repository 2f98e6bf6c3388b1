// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/run_budgets.hpp"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "service/host/soak/report/soak_report.hpp"
#include "service/text/printed.hpp"

namespace meridian::soak {
namespace {

using text::append;
using text::json_quoted;
using Verdict = CheckResult::Verdict;

constexpr double kMicro = 1e-3;
constexpr const char* kComputation = "cycle computation";
constexpr const char* kNotWatched = "the host was not watched: no right to real time";

[[nodiscard]] CheckResult checked(const probe::Budget& budget, double figure,
                                  double reference = 0) {
  const bool is_kept = budget.is_kept(figure, reference);
  return {budget, figure, reference, is_kept ? Verdict::kKept : Verdict::kBroken, ""};
}

[[nodiscard]] std::string too_short(const char* what) {
  return std::string("too short: ") + what + " " + std::to_string(kMinSamples);
}

/// The same without a verdict, for the reason `why`.
[[nodiscard]] CheckResult left_open(CheckResult result, std::string why) {
  result.verdict = Verdict::kNotChecked;
  result.why = std::move(why);
  return result;
}

[[nodiscard]] CheckResult check_faults(const SoakReport& report) {
  double faults = 0;
  bool has_ready = false, is_locked = true;
  for (const Life& life : report.lives) {
    if (life.ready.empty()) continue;
    has_ready = true;
    is_locked = is_locked && life.last.process.locked_mib > 0;
    for (const char* const name : {"cycle", "publisher"}) {
      faults += static_cast<double>(faults_of(life.ready, life.last.threads, name));
    }
  }
  const CheckResult result = checked(report.budgets.page_faults, faults);
  if (!has_ready) return left_open(result, "the machine was never Ready");
  return is_locked ? result : left_open(result, "memory could not be locked");
}

[[nodiscard]] CheckResult check_lost(const SoakReport& report) {
  const auto own = static_cast<double>(report.periods_lost - report.periods_lost_to_host);
  const auto all = static_cast<double>(report.cycles_run + report.periods_lost);
  const CheckResult result = checked(report.budgets.periods_lost, all > 0 ? 100 * own / all : 0);
  if (!report.is_host_watched) return left_open(result, kNotWatched);
  if (report.cycles_run < kMinSamples) return left_open(result, too_short("fewer cycles than"));
  return result;
}

/// A ring is full where its reader was kept from its processor, too.
[[nodiscard]] CheckResult check_overruns(const SoakReport& report) {
  const auto own = static_cast<double>(report.overruns - report.overruns_by_host);
  const CheckResult result = checked(report.budgets.overruns, own);
  if (result.verdict == Verdict::kKept || report.is_host_watched) return result;
  return left_open(result, kNotWatched);
}

/// Of the life that switched most.
[[nodiscard]] CheckResult check_switches(const SoakReport& report) {
  std::optional<double> max;
  bool is_real_time = false;
  for (const Life& life : report.lives) {
    const auto* const first = thread_of(life.first.threads, "cycle");
    const auto* const last = thread_of(life.last.threads, "cycle");
    if (!life.has_first || first == nullptr || last == nullptr) continue;
    is_real_time |= last->policy == SCHED_FIFO;
    const std::uint64_t cycles = life.last.cycles_run - life.first.cycles_run;
    if (cycles < kMinSamples) continue;
    const auto switches = static_cast<double>(last->voluntary_switches - first->voluntary_switches);
    max = std::max(max.value_or(0), switches / static_cast<double>(cycles));
  }
  const CheckResult result = checked(report.budgets.switches, max.value_or(0));
  if (!max) return left_open(result, too_short("no life of so many cycles:"));
  return is_real_time ? result : left_open(result, "the cycle had no real-time priority");
}

/// The share of its time for which a witness that naps for `nap_ns` was kept waiting.
[[nodiscard]] double away_share(const Histogram& lateness, std::int64_t nap_ns) {
  constexpr std::int64_t kAway_ns = 1'000'000;
  double away_ns = 0;
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) {
    const std::int64_t late_ns = Histogram::bucket_end_ns(i);
    if (late_ns >= kAway_ns)
      away_ns += static_cast<double>(lateness.bucket(i)) * static_cast<double>(late_ns);
  }
  const double time_ns =
      static_cast<double>(lateness.count()) * static_cast<double>(nap_ns) + away_ns;
  return time_ns > 0 ? away_ns / time_ns : 0;
}

[[nodiscard]] CheckResult check_drift(const SoakReport& report, const RunBudgets::Drift& drift,
                                      TimeSlices::Named& first, TimeSlices::Named& last) {
  const auto us = [&drift](const Histogram& one) {
    return kMicro * static_cast<double>(one.percentile_ns(drift.share));
  };
  const Histogram &before = first[drift.histogram], &after = last[drift.histogram];
  const Histogram &bare_before = first[kBareThread], &bare_after = last[kBareThread];
  const CheckResult result = checked(drift.budget, us(after), us(before));
  if (std::min(before.count(), after.count()) < kMinSamples) {
    return left_open(result, too_short("a quarter of the run has fewer samples than"));
  }
  constexpr double kSameWork = 0.05;
  const double cut_before = first[kCutting].mean_ns(), cut_after = last[kCutting].mean_ns();
  if (drift.histogram == kComputation && std::abs(cut_after - cut_before) > kSameWork) {
    std::string why;
    append(why,
           "a cycle that cuts computes longer: %.0f %% of the first quarter cut, %.0f %% of "
           "the last",
           100 * cut_before, 100 * cut_after);
    return left_open(result, why);
  }
  if (result.verdict == Verdict::kKept) return result;
  if (!report.is_host_watched) return left_open(result, kNotWatched);
  // What the host alone did to more than half of the values beyond the percentile decides nothing.
  const double away = std::max(away_share(bare_before, report.host_nap_ns),
                               away_share(bare_after, report.host_nap_ns));
  std::string why;
  if (away > (1 - drift.share) / 2) {
    append(why, "the host took the processor away for %.3f %% of a quarter", 100 * away);
  } else if (!drift.budget.is_kept(us(bare_after), us(bare_before))) {
    append(why, "a bare thread of highest priority there went from %.1f to %.1f us",
           us(bare_before), us(bare_after));
  }
  return why.empty() ? result : left_open(result, why);
}

[[nodiscard]] const char* word(Verdict verdict) noexcept {
  return verdict == Verdict::kKept     ? "kept"
         : verdict == Verdict::kBroken ? "BROKEN"
                                       : "not checked";
}

}  // namespace

RunBudgets load_run_budgets() {
  return {.page_faults = probe::load_budget("cycle_page_faults"),
          .periods_lost = probe::load_budget("soak_periods_lost"),
          .overruns = probe::load_budget("soak_overruns"),
          .switches = probe::load_budget("soak_cycle_switches"),
          .drifts = {{kComputation, 0.5, probe::load_budget("soak_computation_drift_p50")},
                     {kComputation, 0.999, probe::load_budget("soak_computation_drift_p999")},
                     {"wake-up lateness", 0.5, probe::load_budget("soak_lateness_drift_p50")},
                     {"wake-up lateness", 0.999, probe::load_budget("soak_lateness_drift_p999")}}};
}

std::vector<CheckResult> check_run(const SoakReport& report) {
  std::vector<CheckResult> all{check_faults(report), check_lost(report), check_overruns(report),
                               check_switches(report)};
  TimeSlices::Named first = report.slices.first_quarter(report.elapsed_s);
  TimeSlices::Named last = report.slices.last_quarter(report.elapsed_s);
  for (const RunBudgets::Drift& drift : report.budgets.drifts) {
    all.push_back(check_drift(report, drift, first, last));
  }
  return all;
}

std::string to_text(const std::vector<CheckResult>& results) {
  std::string out;
  for (const CheckResult& one : results) {
    append(out, "  %-10s %-28s %.6g, allowed %.6g %s", word(one.verdict), one.budget.name.c_str(),
           one.figure, one.budget.allowed(one.reference), one.budget.unit.c_str());
    if (!one.why.empty()) append(out, " (%s)", one.why.c_str());
    out += '\n';
  }
  return out;
}

std::string to_json(const std::vector<CheckResult>& results) {
  std::string out = "[";
  const char* separator = "";
  for (const CheckResult& one : results) {
    append(out, "%s\n  {\"budget\": %s, \"figure\": %.6g, \"allowed\": %.6g, \"unit\": %s, ",
           separator, json_quoted(one.budget.name).c_str(), one.figure,
           one.budget.allowed(one.reference), json_quoted(one.budget.unit).c_str());
    append(out, "\"reference\": %.6g, \"verdict\": \"%s\", \"why\": %s}", one.reference,
           one.verdict == Verdict::kBroken ? "broken" : word(one.verdict),
           json_quoted(one.why).c_str());
    separator = ",";
  }
  return out + "]";
}

}  // namespace meridian::soak
