// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "meridian/units.hpp"
#include "service/host/soak/report/soak_report.hpp"
#include "service/text/printed.hpp"

namespace meridian::soak {
namespace {

using text::append;
using text::Count;
using text::json_quoted;

[[nodiscard]] double in_us(const Histogram& histogram, double share) {
  return static_cast<double>(histogram.percentile_ns(share)) * 1e-3;
}

void append_threads(std::string& out, const Life& life) {
  const char* separator = "";
  for (const process::ThreadAccount& one : life.last.threads) {
    const auto before = std::ranges::find(life.ready, one.id, &process::ThreadAccount::id);
    const std::uint64_t faults =
        before == life.ready.end()
            ? 0
            : one.minor_faults + one.major_faults - before->minor_faults - before->major_faults;
    append(out,
           "%s\n   {\"name\": %s, \"scheduling\": %s, \"processors\": %s, "
           "\"faults_since_ready\": %llu, \"voluntary_switches\": %llu, "
           "\"involuntary_switches\": %llu}",
           separator, json_quoted(one.name).c_str(), json_quoted(scheduling_text(one)).c_str(),
           json_quoted(one.processors).c_str(), Count{faults}, Count{one.voluntary_switches},
           Count{one.involuntary_switches});
    separator = ",";
  }
}

}  // namespace

std::string to_json(const SoakReport& report) {
  std::string out = "{\"passed\": ";
  append(out,
         "%s, \"over\": %s, \"interrupted\": %s, \"machine\": %s, \"host\": %s, \"seed\": %llu,\n",
         report.passed() ? "true" : "false", report.is_over ? "true" : "false",
         report.is_interrupted ? "true" : "false", json_quoted(report.machine).c_str(),
         json_quoted(report.host).c_str(), Count{report.seed});
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
         " \"periods_lost\": %llu, \"periods_lost_to_host\": %llu, \"overruns\": %llu, "
         "\"overruns_by_host\": %llu, \"starvations\": %llu,\n",
         Count{report.periods_lost}, Count{report.periods_lost_to_host}, Count{report.overruns},
         Count{report.overruns_by_host}, Count{report.starvations});
  append(out, " \"service_file\": %s, \"enforced\": %s, \"cpu\": %d, \"traces\": %s,\n",
         json_quoted(report.service_file).c_str(), report.is_enforced ? "true" : "false",
         report.cpu, json_quoted(report.traces).c_str());
  out += " \"budgets\": " + to_json(check_run(report)) + ",\n \"services\": [";
  const char* separator = "";
  for (const Life& life : report.lives) {
    append(out,
           "%s\n  {\"resident_mib\": %.2f, \"max_resident_mib\": %.2f, \"locked_mib\": %.2f, "
           "\"files\": %d, \"threads\": %d, \"thread_list\": [",
           separator, life.last.process.resident_mib, life.max_resident_mib,
           life.last.process.locked_mib, life.last.process.files, life.last.process.threads);
    append_threads(out, life);
    out += "]}";
    separator = ", ";
  }
  out += "],\n \"latencies\": [";
  separator = "";
  for (const auto& [name, drift] : report.latencies) {
    append(out,
           "%s\n  {\"name\": %s, \"samples\": %llu, \"p50_us\": %.3f, \"p99_us\": %.3f, "
           "\"p999_us\": %.3f, \"max_us\": %.3f, \"first_p99_us\": %.3f, \"last_p99_us\": %.3f}",
           separator, json_quoted(name).c_str(), Count{drift.all.count()}, in_us(drift.all, 0.5),
           in_us(drift.all, 0.99), in_us(drift.all, 0.999), in_us(drift.all, 1),
           in_us(drift.first, 0.99), in_us(drift.last, 0.99));
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
