// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/soak_report.hpp"

#include <algorithm>
#include <utility>

#include "meridian/units.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/text/printed.hpp"

namespace meridian::soak {
namespace {

using text::append;
using text::Count;

constexpr double kUs = 1e-3;

[[nodiscard]] double us(const Histogram& histogram, double share) {
  return static_cast<double>(histogram.percentile_ns(share)) * kUs;
}

void append_mishaps(std::string& out, const SoakReport& report) {
  const char* separator = "";
  for (int i = 0; i < kMishapCount; ++i) {
    const std::uint64_t count = report.mishaps[static_cast<std::size_t>(i)];
    if (count == 0) continue;
    append(out, "%s%llu %s", separator, Count{count}, word(static_cast<Mishap>(i)));
    separator = ", ";
  }
  if (*separator == '\0') out += "none";
}

/// Page faults since Ready of every real-time thread but cycle and publisher, which have a budget.
[[nodiscard]] std::uint64_t faults_of_others(const Life& life) {
  std::uint64_t sum = 0;
  for (const process::ThreadAccount& one : life.last.threads) {
    const bool is_checked = one.name == "cycle" || one.name == "publisher";
    const auto same = std::ranges::find(life.ready, one.id, &process::ThreadAccount::id);
    if (is_checked || one.priority == 0 || same == life.ready.end()) continue;
    sum += one.minor_faults + one.major_faults - same->minor_faults - same->major_faults;
  }
  return sum;
}

[[nodiscard]] process::ThreadAccount grown(const Life& life, const std::string& name) {
  const auto *const first = thread_of(life.first.threads, name), *const last = thread_of(
                                                                     life.last.threads, name);
  process::ThreadAccount out = last != nullptr ? *last : process::ThreadAccount{};
  if (first == nullptr || last == nullptr) return out;
  out.voluntary_switches -= first->voluntary_switches;
  out.involuntary_switches -= first->involuntary_switches;
  return out;
}

void append_lives(std::string& out, const SoakReport& report) {
  for (std::size_t i = 0; i < report.lives.size(); ++i) {
    const Life& life = report.lives[i];
    if (!life.has_first) continue;
    append(out,
           "  service %zu: resident %.1f -> %.1f MiB (most %.1f, locked %.1f), files %d -> %d, "
           "threads %d -> %d\n",
           i + 1, life.first.process.resident_mib, life.last.process.resident_mib,
           life.max_resident_mib, life.last.process.locked_mib, life.first.process.files,
           life.last.process.files, life.first.process.threads, life.last.process.threads);
    const process::ThreadAccount cycle = grown(life, "cycle"), publisher = grown(life, "publisher");
    append(out,
           "    page faults since Ready: cycle %llu, publisher %llu, other real-time threads %llu; "
           "switches: cycle %llu voluntary, %llu not, publisher %llu, %llu\n",
           Count{faults_of(life.ready, life.last.threads, "cycle")},
           Count{faults_of(life.ready, life.last.threads, "publisher")},
           Count{faults_of_others(life)}, Count{cycle.voluntary_switches},
           Count{cycle.involuntary_switches}, Count{publisher.voluntary_switches},
           Count{publisher.involuntary_switches});
  }
}

/// What was asked for, and what the kernel says that ran.
void append_scheduling(std::string& out, const SoakReport& report) {
  append(out, "  service: %s, real time %s, cycle for processor %d",
         report.service_file.empty() ? "default" : report.service_file.c_str(),
         report.is_enforced ? "enforced" : "best effort", report.cpu);
  if (!report.lives.empty()) {
    for (const char* const name : {"cycle", "publisher"}) {
      const auto* const thread = thread_of(report.lives.back().last.threads, name);
      if (thread == nullptr) continue;
      append(out, "; %s ran %s on %s", name, scheduling_text(*thread).c_str(),
             thread->processors.c_str());
    }
  }
  out += '\n';
  if (!report.traces.empty()) append(out, "  traces of slow cycles: %s\n", report.traces.c_str());
}

/// A soak that is not at its end passes so far, and no further.
void append_verdict(std::string& out, const SoakReport& report,
                    const std::vector<CheckResult>& results) {
  const bool is_clean = report.is_clean(results);
  out += is_clean ? "PASS" : "FAIL";
  if (report.is_interrupted) {
    append(out, "%s, interrupted after %.0f s of %.0f s", is_clean ? " so far" : "",
           report.elapsed_s, report.asked_s);
  } else if (!report.is_over && is_clean) {
    out += " so far";
  }
  const auto left =
      std::ranges::count(results, CheckResult::Verdict::kNotChecked, &CheckResult::verdict);
  append(out,
         ": %llu violations of limits, tolerance, sequence or state; %zu of %zu budgets checked\n",
         Count{report.violation_count}, results.size() - static_cast<std::size_t>(left),
         results.size());
}

}  // namespace

GrowthBudgets load_growth_budgets(bool is_traced) {
  const double traces_mib = is_traced ? probe::load_budget("trace_memory").allowed() : 0;
  return {.resident_mib = probe::load_budget("resident_memory").allowed() + traces_mib,
          .more_mib = probe::load_budget("soak_memory_growth").allowed(),
          .more_files = probe::load_budget("soak_file_growth").allowed(),
          .more_threads = probe::load_budget("soak_thread_growth").allowed()};
}

const process::ThreadAccount* thread_of(const std::vector<process::ThreadAccount>& threads,
                                        const std::string& name) {
  const auto at = std::ranges::find(threads, name, &process::ThreadAccount::name);
  return at == threads.end() ? nullptr : &*at;
}

std::uint64_t faults_of(const std::vector<process::ThreadAccount>& first,
                        const std::vector<process::ThreadAccount>& last, const std::string& name) {
  const auto *const before = thread_of(first, name), *const after = thread_of(last, name);
  if (before == nullptr || after == nullptr) return 0;
  return after->minor_faults + after->major_faults - before->minor_faults - before->major_faults;
}

void SoakReport::violate(std::string text, std::string where) {
  ++violation_count;
  if (violations.size() < kMaxViolations) violations.push_back({std::move(text), std::move(where)});
}

void SoakReport::add(const record::CheckReport& check, const std::string& where) {
  ++segments;
  rows += check.rows;
  missing += check.missing;
  longest_gap = std::max(longest_gap, check.longest_gap);
  tip_mm = std::max({tip_mm, check.tip_mm.value, check.tip_between_mm.value});
  axis_rad = std::max({axis_rad, check.axis_rad.value, check.axis_between_rad.value});
  for (int i = 0; i < check.joint_count; ++i) {
    const record::JointUse& use = check.joints[static_cast<std::size_t>(i)];
    velocity = std::max(velocity, use.velocity.value);
    acceleration = std::max(acceleration, use.acceleration.value);
    jerk = std::max(jerk, use.jerk.value);
  }
  for (const record::Finding& finding : check.findings) violate(finding.text, where);
}

bool SoakReport::is_clean(const std::vector<CheckResult>& results) const {
  return violation_count == 0 && host_faults == 0 && finished > 0 && segments_unread == 0 &&
         growth(*this).empty() && std::ranges::none_of(results, [](const CheckResult& one) {
           return one.verdict == CheckResult::Verdict::kBroken;
         });
}

std::vector<std::string> growth(const SoakReport& report) {
  std::vector<std::string> found;
  for (const Life& life : report.lives) {
    std::string text;
    const auto grew_by = [&life](auto figure, double max) {
      return life.has_first && static_cast<double>(life.last.process.*figure) -
                                       static_cast<double>(life.first.process.*figure) >
                                   max;
    };
    if (life.max_resident_mib > report.allowed.resident_mib) {
      append(text, "%.1f MiB resident, budget %.0f", life.max_resident_mib,
             report.allowed.resident_mib);
    } else if (grew_by(&process::Account::resident_mib, report.allowed.more_mib)) {
      append(text, "resident memory grew from %.1f to %.1f MiB", life.first.process.resident_mib,
             life.last.process.resident_mib);
    } else if (grew_by(&process::Account::threads, report.allowed.more_threads)) {
      append(text, "threads grew from %d to %d", life.first.process.threads,
             life.last.process.threads);
    }
    if (text.empty() && grew_by(&process::Account::files, report.allowed.more_files)) {
      append(text, "open files grew from %d to %d", life.first.process.files,
             life.last.process.files);
    }
    if (!text.empty()) found.push_back(text);
  }
  return found;
}

std::string to_text(const SoakReport& report) {
  std::string out = report.host + "\n";
  append(out, "soak of machine %s: %.0f s of %.0f s%s, seed %llu\n", report.machine.c_str(),
         report.elapsed_s, report.asked_s,
         report.is_interrupted ? ", interrupted"
         : report.is_over      ? ""
                               : " so far",
         Count{report.seed});
  append_scheduling(out, report);
  append(out, "  programs %llu: finished %llu, broken off %llu, refused %llu; alarms %llu\n",
         Count{report.programs}, Count{report.finished}, Count{report.aborted},
         Count{report.refused}, Count{report.alarms});
  out += "  mishaps: ";
  append_mishaps(out, report);
  append(out, "; asks refused %llu, unanswered %llu", Count{report.asks_refused},
         Count{report.asks_unanswered});
  append(out, "\n  checked: %llu recordings, %llu setpoints, %llu missing, longest gap %llu\n",
         Count{report.segments}, Count{report.rows}, Count{report.missing},
         Count{report.longest_gap});
  append(
      out,
      "  largest deviation: tip %.6f mm, axis %.6f deg; largest share of a limit: velocity %.4f, "
      "acceleration %.4f, jerk %.4f\n",
      report.tip_mm, units::deg_from_rad(report.axis_rad), report.velocity, report.acceleration,
      report.jerk);
  append(out,
         "  cycles %llu, periods lost %llu (to stalls of the host %llu), starved %llu times, "
         "overruns %llu (by stalls of the host %llu)\n",
         Count{report.cycles_run}, Count{report.periods_lost}, Count{report.periods_lost_to_host},
         Count{report.starvations}, Count{report.overruns}, Count{report.overruns_by_host});
  if (report.is_host_watched) {
    append(out, "  host took a processor away for 10 ms and more: %llu times, at most %.1f ms\n",
           Count{report.host_stalls}, 1e3 * report.host_longest_s);
  } else {
    out += "  host not watched: no right to real time\n";
  }
  append_lives(out, report);
  out += "  latency, us               p50       p99     p99.9       max   p99 first    p99 last\n";
  for (const auto& [name, drift] : report.latencies) {
    append(out, "  %-20s %8.1f  %8.1f  %8.1f %9.1f   %9.1f   %9.1f\n", name.c_str(),
           us(drift.all, 0.5), us(drift.all, 0.99), us(drift.all, 0.999), us(drift.all, 1),
           us(drift.first, 0.99), us(drift.last, 0.99));
  }
  const std::vector<CheckResult> results = check_run(report);
  out += "  budgets of the run:\n" + to_text(results);
  for (const std::string& text : growth(report)) append(out, "  GROWTH: %s\n", text.c_str());
  for (const Violation& one : report.violations) {
    append(out, "  VIOLATION: %s (%s)\n", one.text.c_str(), one.where.c_str());
  }
  append_verdict(out, report, results);
  if (report.host_faults > 0) {
    append(
        out,
        "HOST NOT FIT: %llu Faults because it kept service or drives from their processors for too "
        "long\n",
        Count{report.host_faults});
  }
  return out;
}

}  // namespace meridian::soak
