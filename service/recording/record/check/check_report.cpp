// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/check_report.hpp"

#include <string_view>

#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::record {

using text::append;
using text::Count;
using text::json_quoted;

namespace {

[[nodiscard]] std::string location(const Peak& peak) {
  std::string text;
  append(text, "cycle %llu, line %u", static_cast<Count>(peak.cycle), peak.line);
  return text;
}

void append_peak(std::string& text, const char* name, const Peak& peak, double scale = 1) {
  append(text, "  \"%s\": {\"value\": %.9g, \"cycle\": %llu, \"line\": %u},\n", name,
         peak.value * scale, static_cast<Count>(peak.cycle), peak.line);
}

/// Extreme position of a joint at the edge: mm or deg.
[[nodiscard]] double at_edge(const CheckReport& report, int joint, double value) {
  return report.is_rotary[joint] ? units::deg_from_rad(value) : value;
}

void append_deviation(std::string& text, const char* name, const Peak& at, const Peak& between,
                      double scale, const char* unit, double tolerance) {
  append(text, "%-10s %.6f %s at the setpoints (%s), %.6f %s between; tolerance %.6g %s", name,
         at.value * scale, unit, location(at).c_str(), between.value * scale, unit,
         tolerance * scale, unit);
}

}  // namespace

std::string_view word(Finding::Kind kind) noexcept {
  switch (kind) {
    case Finding::Kind::kEmpty:
      return "empty";
    case Finding::Kind::kMissingCycles:
      return "missing_cycles";
    case Finding::Kind::kCycleOrder:
      return "cycle_order";
    case Finding::Kind::kDueGrid:
      return "due_grid";
    case Finding::Kind::kTip:
      return "tip";
    case Finding::Kind::kAxis:
      return "axis";
    case Finding::Kind::kVertex:
      return "vertex";
    case Finding::Kind::kOrder:
      return "order";
    case Finding::Kind::kUnfinished:
      return "unfinished";
    case Finding::Kind::kFeed:
      return "feed";
    case Finding::Kind::kCreep:
      return "creep";
    case Finding::Kind::kTurnRate:
      return "turn_rate";
    case Finding::Kind::kBlockTime:
      return "block_time";
    case Finding::Kind::kVelocity:
      return "velocity";
    case Finding::Kind::kAcceleration:
      return "acceleration";
    case Finding::Kind::kJerk:
      return "jerk";
    case Finding::Kind::kTravel:
      return "travel";
    case Finding::Kind::kSentVelocity:
      return "sent_velocity";
    case Finding::Kind::kStage:
      return "stage";
    case Finding::Kind::kRewind:
      return "rewind";
    case Finding::Kind::kDryAndFollowed:
      return "dry_and_followed";
  }
  return "unknown";
}

std::string to_text(const CheckReport& report) {
  std::string text;
  append(text, "recording  %s: %llu cycles sent, %llu missing", report.recording.c_str(),
         static_cast<Count>(report.rows), static_cast<Count>(report.missing));
  if (report.missing > 0) {
    append(text, " (longest gap %llu)", static_cast<Count>(report.longest_gap));
  }
  append(text, ", %.3f s at %.6g ms\n", report.span_s, report.cycle_s * 1e3);
  append(text, "path       %s: %llu motion blocks, %.3f mm\n", report.path_name.c_str(),
         static_cast<Count>(report.motion_blocks), report.tip_length_mm);
  if (report.begin_cycle == report.end_cycle) {
    text += "cut        nothing\n";
  } else {
    append(text, "cut        cycles %llu to %llu, %.3f s\n", static_cast<Count>(report.begin_cycle),
           static_cast<Count>(report.end_cycle), report.cut_s);
    if (report.dry_cut_cycles > 0) text += "           the cut checked is of a dry run\n";
    if (report.has_later_program) text += "           a later program follows and is not checked\n";
    append_deviation(text, "tip", report.tip_mm, report.tip_between_mm, 1e3, "um",
                     report.tip_tolerance_mm);
    text += "\n";
    append_deviation(text, "axis", report.axis_rad, report.axis_between_rad,
                     units::deg_from_rad(1.0), "deg", report.axis_tolerance_rad);
    if (report.pole_tolerance_rad > report.axis_tolerance_rad) {
      append(text, ", %.6g deg within %.3g deg of the pole",
             units::deg_from_rad(report.pole_tolerance_rad), units::deg_from_rad(kPoleReach_rad));
    }
    text += "\n";
    append(text, "vertices   %llu passed, the farthest by %.6f um (line %u)",
           static_cast<Count>(report.vertices), report.vertex_mm.value * 1e3,
           report.vertex_mm.line);
    if (report.vertices_in_gaps > 0) {
      append(text, ", %llu after missing cycles", static_cast<Count>(report.vertices_in_gaps));
    }
    if (report.rewinds > 0) {
      append(text, "\nrewound    %llu times, off the part", static_cast<Count>(report.rewinds));
    }
    append(text, "\nfeed       %.6f x the programmed feed (%s), tip speed up to %.3f mm/min\n",
           report.feed.value, location(report.feed).c_str(),
           units::per_min_from_per_s(report.tip_speed_mm_per_s.value));
  }
  append(text, "joint      velocity acceleration     jerk  (1 is the limit)      range\n");
  for (int i = 0; i < report.joint_count; ++i) {
    const JointUse& use = report.joints[i];
    append(text, "%-10s %8.6f     %8.6f %8.6f  %12.4f .. %.4f %s\n", report.joint_names[i].c_str(),
           use.velocity.value, use.acceleration.value, use.jerk.value, at_edge(report, i, use.low),
           at_edge(report, i, use.high), report.is_rotary[i] ? "deg" : "mm");
  }
  if (report.has_stage) {
    append(text, "stage      least determinant %.3f mm/rad, drives fit their joints to %.3g mm\n",
           report.stage.determinant_mm, report.stage.apart_mm.value);
  }
  if (report.fault_stop_cycles > 0) {
    append(text, "FaultStop  %llu cycles, checked by the FaultStop limits\n",
           static_cast<Count>(report.fault_stop_cycles));
  }
  if (report.dry_cycles > 0) {
    append(text, "dry run    %llu cycles: no drive followed them\n",
           static_cast<Count>(report.dry_cycles));
  }
  if (report.passed()) return text + "PASS\n";
  text += "FAIL\n";
  for (const Finding& finding : report.findings) {
    text += "  " + finding.text;
    if (finding.line > 0 || finding.cycle > 0) {
      append(text, " (cycle %llu, line %u)", static_cast<Count>(finding.cycle), finding.line);
    }
    text += "\n";
  }
  return text;
}

std::string to_json(const CheckReport& report) {
  std::string text = "{\n";
  text += "  \"recording\": " + json_quoted(report.recording) + ",\n";
  text += "  \"path\": " + json_quoted(report.path_name) + ",\n";
  append(text, "  \"passed\": %s,\n", report.passed() ? "true" : "false");
  append(text, "  \"cycles_sent\": %llu,\n  \"cycles_missing\": %llu,\n  \"longest_gap\": %llu,\n",
         static_cast<Count>(report.rows), static_cast<Count>(report.missing),
         static_cast<Count>(report.longest_gap));
  append(text, "  \"cycle_s\": %.9g,\n  \"cut_s\": %.9g,\n  \"begin_cycle\": %llu,\n",
         report.cycle_s, report.cut_s, static_cast<Count>(report.begin_cycle));
  append(text, "  \"end_cycle\": %llu,\n  \"motion_blocks\": %llu,\n  \"tip_length_mm\": %.9g,\n",
         static_cast<Count>(report.end_cycle), static_cast<Count>(report.motion_blocks),
         report.tip_length_mm);
  append(text, "  \"tip_tolerance_mm\": %.9g,\n  \"axis_tolerance_deg\": %.9g,\n",
         report.tip_tolerance_mm, units::deg_from_rad(report.axis_tolerance_rad));
  append(text, "  \"pole_axis_tolerance_deg\": %.9g,\n",
         units::deg_from_rad(report.pole_tolerance_rad));
  append_peak(text, "tip_mm", report.tip_mm);
  append_peak(text, "tip_between_mm", report.tip_between_mm);
  append_peak(text, "axis_deg", report.axis_rad, units::deg_from_rad(1.0));
  append_peak(text, "axis_between_deg", report.axis_between_rad, units::deg_from_rad(1.0));
  append(text, "  \"rewinds\": %llu,\n", static_cast<Count>(report.rewinds));
  append(text, "  \"vertices\": %llu,\n  \"vertices_in_gaps\": %llu,\n",
         static_cast<Count>(report.vertices), static_cast<Count>(report.vertices_in_gaps));
  append_peak(text, "vertex_mm", report.vertex_mm);
  append_peak(text, "feed_use", report.feed);
  append_peak(text, "tip_speed_mm_per_min", report.tip_speed_mm_per_s,
              units::per_min_from_per_s(1.0));
  if (report.has_stage) {
    append(text, "  \"stage_determinant_mm_per_rad\": %.9g,\n", report.stage.determinant_mm);
    append_peak(text, "stage_apart_mm", report.stage.apart_mm);
  }
  append(text, "  \"fault_stop_cycles\": %llu,\n  \"dry_cycles\": %llu,\n",
         static_cast<Count>(report.fault_stop_cycles), static_cast<Count>(report.dry_cycles));
  append(text, "  \"dry_cut_cycles\": %llu,\n  \"joints\": [",
         static_cast<Count>(report.dry_cut_cycles));
  for (int i = 0; i < report.joint_count; ++i) {
    const JointUse& use = report.joints[i];
    const char* unit = report.is_rotary[i] ? "deg" : "mm";
    append(text, "%s\n    {\"name\": %s, \"velocity_use\": %.9g, \"acceleration_use\": %.9g, ",
           i > 0 ? "," : "", json_quoted(report.joint_names[i]).c_str(), use.velocity.value,
           use.acceleration.value);
    append(text, "\"jerk_use\": %.9g, \"low_%s\": %.9g, \"high_%s\": %.9g}", use.jerk.value, unit,
           at_edge(report, i, use.low), unit, at_edge(report, i, use.high));
  }
  text += "\n  ],\n  \"findings\": [";
  bool is_first = true;
  for (const Finding& finding : report.findings) {
    append(text, "%s\n    {\"kind\": \"%.*s\", \"cycle\": %llu, \"line\": %u, \"count\": %llu, ",
           is_first ? "" : ",", static_cast<int>(word(finding.kind).size()),
           word(finding.kind).data(), static_cast<Count>(finding.cycle), finding.line,
           static_cast<Count>(finding.count));
    text += "\"text\": " + json_quoted(finding.text) + "}";
    is_first = false;
  }
  return text + (is_first ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace meridian::record
