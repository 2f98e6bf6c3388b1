// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/metrics.hpp"

#include <array>
#include <bit>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::panel {
namespace {

using text::append;
using text::Count;

/// The value of a label: backslash, quote and line end escaped.
[[nodiscard]] std::string label(const std::string& value) {
  std::string out;
  for (const char letter : value) {
    if (letter == '\\' || letter == '"') out += '\\';
    if (letter == '\n') {
      out += "\\n";
    } else {
      out += letter;
    }
  }
  return out;
}

/// One family of one machine after the other.
class Families {
 public:
  explicit Families(const std::string& machine) : machine_(label(machine)) {}

  void begin(const char* name, const char* type, const char* help) {
    name_ = name;
    append(text_, "# HELP %s %s\n# TYPE %s %s\n", name, help, name, type);
  }
  /// `labels`: more of them, a comma before each.
  void add(double value, const std::string& labels = "", const char* suffix = "") {
    append(text_, "%s%s{machine=\"%s\"%s} %.17g\n", name_, suffix, machine_.c_str(), labels.c_str(),
           value);
  }
  void one(const char* name, const char* type, const char* help, double value) {
    begin(name, type, help);
    add(value);
  }
  void count(const char* name, const char* help, std::uint64_t value) {
    one(name, "counter", help, static_cast<double>(value));
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string machine_, text_;
  const char* name_ = "";
};

void add_state(Families& out, const dds::Status& status) {
  out.begin("meridian_state", "gauge", "1 for the state that the machine is in.");
  for (int i = 0; i < kStateCount; ++i) {
    const auto state = static_cast<State>(i);
    out.add(status.state == state ? 1 : 0, ",state=\"" + std::string(record::word(state)) + "\"");
  }
  out.begin("meridian_alarm", "gauge", "1 while an alarm is in force; the label names it.");
  out.add(status.alarm != Alarm::kNone ? 1 : 0,
          ",alarm=\"" + std::string(record::word(status.alarm)) + "\"");
}

void add_motion(Families& out, const dds::Status& status) {
  constexpr double kMetrePerSecond = 1e-3 / 60;  // of mm/min
  const auto gauge = [&out](const char* name, const char* help, double value) {
    out.one(name, "gauge", help, value);
  };
  gauge("meridian_feed_programmed_metres_per_second", "Programmed tip feed.",
        status.feed_programmed_mm_per_min * kMetrePerSecond);
  gauge("meridian_feed_achieved_metres_per_second", "Tip speed.",
        status.feed_achieved_mm_per_min * kMetrePerSecond);
  gauge("meridian_feed_override_ratio", "Feed override, 1 is 100 %.", status.feed_override);
  gauge("meridian_rapid_override_ratio", "Rapid override, 1 is 100 %.", status.rapid_override);
  gauge("meridian_planned_seconds", "Plan time between the cycle and the end of the plan.",
        status.planned_s);
  gauge("meridian_blocks_queued", "Blocks that wait for the planner.", status.blocks_queued);
  gauge("meridian_enabled_drives", "Drives in operation enabled.",
        static_cast<double>(std::popcount(status.drives_enabled_mask)));
  gauge("meridian_realtime", "1: real time is enforced; 0: best effort.",
        status.realtime_mode == dds::RealtimeMode::kEnforced ? 1 : 0);
  gauge("meridian_secured", "1: the service has an identity and talks to nobody without one.",
        status.is_secured ? 1 : 0);
}

void add_counters(Families& out, const dds::Status& status) {
  out.count("meridian_cycles_total", "Cycles that were run.", status.cycles_run);
  out.count("meridian_periods_lost_total", "Periods without a setpoint.", status.periods_lost);
  out.count("meridian_starvations_total", "Stops because blocks did not come in time.",
            status.starvations);
  out.count("meridian_batches_dropped_total", "Batches that were not wanted.",
            status.batches_dropped);
  out.count("meridian_batches_lost_total", "Batches that were asked for again.",
            status.batches_lost);
  out.count("meridian_setpoints_overrun_total", "Setpoints that were not sent.",
            status.setpoints_overrun);
  out.count("meridian_records_overrun_total", "Rows missing in the recording.",
            status.records_overrun);
  out.count("meridian_commands_dropped_total", "Commands beyond what one participant may send.",
            status.commands_dropped);
}

/// Bounds of the series, s. Buckets of the topic are finer: 32 an octave.
constexpr std::array kBounds_s{1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4,
                               1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1,  1.0};

void add_histogram(Families& out, const dds::NamedHistogram& one) {
  const std::string stage = ",stage=\"" + label(one.name) + "\"";
  std::uint64_t below = 0;
  std::size_t next = 0;
  for (const double bound : kBounds_s) {
    const auto bound_ns = static_cast<std::int64_t>(bound * 1e9);
    for (; next < Histogram::kBuckets && Histogram::bucket_end_ns(next) <= bound_ns; ++next) {
      below += one.histogram.bucket(next);
    }
    std::string labels = stage;
    append(labels, ",le=\"%g\"", bound);
    out.add(static_cast<double>(below), labels, "_bucket");
  }
  const auto count = static_cast<double>(one.histogram.count());
  out.add(count, stage + ",le=\"+Inf\"", "_bucket");
  out.add(static_cast<double>(one.histogram.sum_ns()) * 1e-9, stage, "_sum");
  out.add(count, stage, "_count");
}

}  // namespace

std::string metrics_text(const dds::MachineInfo& machine, const std::optional<dds::Status>& status,
                         const std::optional<dds::Latency>& latency) {
  Families out(machine.name);
  out.one("meridian_up", "gauge", "1 while the service of this machine speaks.", status ? 1 : 0);
  out.begin("meridian_service_info", "gauge", "What serves the machine; always 1.");
  out.add(1, ",version=\"" + label(machine.service_version) + "\",host=\"" + label(machine.host) +
                 "\",file_version=\"" + label(machine.file_version) + "\"");
  if (!status) return std::move(out).text();
  add_state(out, *status);
  add_motion(out, *status);
  add_counters(out, *status);
  if (!latency || latency->histograms.empty()) return std::move(out).text();
  out.begin("meridian_latency_seconds", "histogram", "Time that each stage of the cycle takes.");
  for (const dds::NamedHistogram& one : latency->histograms) add_histogram(out, one);
  return std::move(out).text();
}

}  // namespace meridian::panel
