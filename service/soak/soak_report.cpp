// SPDX-License-Identifier: Apache-2.0
#include "service/soak/soak_report.hpp"

#include <algorithm>
#include <utility>

#include "meridian/units.hpp"
#include "service/probe/budgets.hpp"
#include "service/text/printed.hpp"

namespace meridian::soak {
namespace {

using text::append;
using text::Count;
using text::json_quoted;

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

void append_lives(std::string& out, const SoakReport& report) {
  for (std::size_t i = 0; i < report.lives.size(); ++i) {
    const Life& life = report.lives[i];
    if (!life.has_first) continue;
    const auto faults = [](const process::ThreadAccount& a, const process::ThreadAccount& b) {
      return Count{b.minor_faults + b.major_faults - a.minor_faults - a.major_faults};
    };
    append(
        out,
        "  service %zu: resident %.1f -> %.1f MiB (most %.1f), files %d -> %d, threads %d -> %d\n",
        i + 1, life.first.process.resident_mib, life.last.process.resident_mib,
        life.most_resident_mib, life.first.process.files, life.last.process.files,
        life.first.process.threads, life.last.process.threads);
    append(out,
           "    page faults after warm-up: cycle %llu, publisher %llu; switches of the cycle: %llu "
           "voluntary, %llu not\n",
           faults(life.first.cycle, life.last.cycle),
           faults(life.first.publisher, life.last.publisher),
           Count{life.last.cycle.voluntary_switches - life.first.cycle.voluntary_switches},
           Count{life.last.cycle.involuntary_switches - life.first.cycle.involuntary_switches});
  }
}

}  // namespace

GrowthBudgets load_growth_budgets() {
  return {.resident_mib = probe::load_budget("resident_memory").allowed(),
          .more_mib = probe::load_budget("soak_memory_growth").allowed(),
          .more_files = probe::load_budget("soak_file_growth").allowed(),
          .more_threads = probe::load_budget("soak_thread_growth").allowed()};
}

void SoakReport::violate(std::string text, std::string where) {
  ++violation_count;
  if (violations.size() < kMostViolations)
    violations.push_back({std::move(text), std::move(where)});
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

bool SoakReport::passed() const {
  return violation_count == 0 && host_faults == 0 && finished > 0 && segments_unread == 0 &&
         growth(*this).empty();
}

std::vector<std::string> growth(const SoakReport& report) {
  std::vector<std::string> found;
  for (const Life& life : report.lives) {
    std::string text;
    const auto grew_by = [&life](auto figure, double most) {
      return life.has_first && static_cast<double>(life.last.process.*figure) -
                                       static_cast<double>(life.first.process.*figure) >
                                   most;
    };
    if (life.most_resident_mib > report.allowed.resident_mib) {
      append(text, "%.1f MiB resident, budget %.0f", life.most_resident_mib,
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
         report.elapsed_s, report.asked_s, report.is_over ? "" : " so far", Count{report.seed});
  append(out, "  programs %llu: finished %llu, broken off %llu, refused %llu; alarms %llu\n",
         Count{report.programs}, Count{report.finished}, Count{report.aborted},
         Count{report.refused}, Count{report.alarms});
  out += "  mishaps: ";
  append_mishaps(out, report);
  append(out, "; asks refused %llu, unanswered %llu", Count{report.asks_refused},
         Count{report.asks_unanswered});
  append(out, "\n  judged: %llu recordings, %llu setpoints, %llu missing, longest gap %llu\n",
         Count{report.segments}, Count{report.rows}, Count{report.missing},
         Count{report.longest_gap});
  append(
      out,
      "  largest deviation: tip %.6f mm, axis %.6f deg; largest share of a limit: velocity %.4f, "
      "acceleration %.4f, jerk %.4f\n",
      report.tip_mm, units::deg_from_rad(report.axis_rad), report.velocity, report.acceleration,
      report.jerk);
  append(out, "  cycles %llu, periods lost %llu, starved %llu times, overruns %llu\n",
         Count{report.cycles_run}, Count{report.periods_lost}, Count{report.starvations},
         Count{report.overruns});
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
  for (const std::string& text : growth(report)) append(out, "  GROWTH: %s\n", text.c_str());
  for (const Violation& one : report.violations) {
    append(out, "  VIOLATION: %s (%s)\n", one.text.c_str(), one.where.c_str());
  }
  append(out, "%s: %llu violations of limits, tolerance, sequence or state\n",
         report.passed() ? "PASS" : "FAIL", Count{report.violation_count});
  if (report.host_faults > 0) {
    append(
        out,
        "HOST NOT FIT: %llu Faults because it kept service or drives from their processors for too "
        "long\n",
        Count{report.host_faults});
  }
  return out;
}

std::string to_json(const SoakReport& report) {
  std::string out = "{\"passed\": ";
  append(out, "%s, \"over\": %s, \"machine\": %s, \"host\": %s, \"seed\": %llu,\n",
         report.passed() ? "true" : "false", report.is_over ? "true" : "false",
         json_quoted(report.machine).c_str(), json_quoted(report.host).c_str(), Count{report.seed});
  append(out, " \"elapsed_s\": %.1f, \"asked_s\": %.1f, \"programs\": %llu, \"finished\": %llu,\n",
         report.elapsed_s, report.asked_s, Count{report.programs}, Count{report.finished});
  append(out, " \"broken_off\": %llu, \"refused\": %llu, \"alarms\": %llu, \"mishaps\": {",
         Count{report.aborted}, Count{report.refused}, Count{report.alarms});
  for (int i = 0; i < kMishapCount; ++i) {
    append(out, "%s\"%s\": %llu", i > 0 ? ", " : "", word(static_cast<Mishap>(i)),
           Count{report.mishaps[static_cast<std::size_t>(i)]});
  }
  append(out, "}, \"host_faults\": %llu, \"host_watched\": %s", Count{report.host_faults},
         report.is_host_watched ? "true" : "false");
  append(out, ", \"host_stalls\": %llu, \"host_longest_ms\": %.3f", Count{report.host_stalls},
         1e3 * report.host_longest_s);
  append(out, ", \"asks_refused\": %llu, \"asks_unanswered\": %llu", Count{report.asks_refused},
         Count{report.asks_unanswered});
  append(out, ",\n \"recordings\": %llu, \"setpoints\": %llu, \"missing\": %llu,\n",
         Count{report.segments}, Count{report.rows}, Count{report.missing});
  append(out, " \"tip_mm\": %.9f, \"axis_deg\": %.9f, \"velocity_share\": %.6f,\n", report.tip_mm,
         units::deg_from_rad(report.axis_rad), report.velocity);
  append(out, " \"acceleration_share\": %.6f, \"jerk_share\": %.6f, \"cycles\": %llu,\n",
         report.acceleration, report.jerk, Count{report.cycles_run});
  append(out,
         " \"periods_lost\": %llu, \"overruns\": %llu, \"starvations\": %llu,\n \"services\": [",
         Count{report.periods_lost}, Count{report.overruns}, Count{report.starvations});
  const char* separator = "";
  for (const Life& life : report.lives) {
    append(
        out,
        "%s{\"resident_mib\": %.2f, \"most_resident_mib\": %.2f, \"files\": %d, \"threads\": %d}",
        separator, life.last.process.resident_mib, life.most_resident_mib, life.last.process.files,
        life.last.process.threads);
    separator = ", ";
  }
  out += "],\n \"latencies\": [";
  separator = "";
  for (const auto& [name, drift] : report.latencies) {
    append(out,
           "%s\n  {\"name\": %s, \"samples\": %llu, \"p50_us\": %.3f, \"p99_us\": %.3f, "
           "\"p999_us\": %.3f, \"max_us\": %.3f, \"first_p99_us\": %.3f, \"last_p99_us\": %.3f}",
           separator, json_quoted(name).c_str(), Count{drift.all.count()}, us(drift.all, 0.5),
           us(drift.all, 0.99), us(drift.all, 0.999), us(drift.all, 1), us(drift.first, 0.99),
           us(drift.last, 0.99));
    separator = ",";
  }
  append(out, "],\n \"violation_count\": %llu, \"violations\": [", Count{report.violation_count});
  separator = "";
  for (const Violation& one : report.violations) {
    out += std::string(separator) + "\n  {\"text\": " + json_quoted(one.text) +
           ", \"where\": " + json_quoted(one.where) + "}";
    separator = ",";
  }
  return out + "]}\n";
}

}  // namespace meridian::soak
