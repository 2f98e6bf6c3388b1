// SPDX-License-Identifier: Apache-2.0
#include "service/cli/status_text.hpp"

#include <strings.h>

#include <algorithm>
#include <cmath>

#include "meridian/cycle/state_table.hpp"
#include "meridian/units.hpp"
#include "service/cli/progress_text.hpp"
#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::cli {

using text::append;
using text::Count;
using text::json_number;
using text::json_quoted;

namespace {

std::size_t joint_count(const dds::MachineInfo& machine) {
  return std::min<std::size_t>(machine.joint_count, kMaxJoints);
}

/// The joint, or behind the joints the drive of the stage; empty: there is none.
std::string limited_name(const dds::MachineInfo& machine, std::size_t index) {
  const std::size_t joints = joint_count(machine);
  if (index < joints) return machine.joints[index].name;
  const std::size_t drives =
      std::min<std::size_t>(machine.stage_drive_count, machine.stage_drives.size());
  return index - joints < drives ? machine.stage_drives[index - joints].name : "";
}

/// The joint, or drive of the stage, of the alarm in force; empty: it is of none.
std::string alarm_joint(const dds::Status& status, const dds::MachineInfo& machine) {
  return record::is_of_joint(status.alarm) ? limited_name(machine, status.alarm_joint) : "";
}

/// What keeps the feed below the programmed one; empty: nothing does.
std::string held_by(const dds::Status& status, const dds::MachineInfo& machine) {
  return status.limiting_joint < 0
             ? ""
             : limited_name(machine, static_cast<std::size_t>(status.limiting_joint));
}

/// Where the program is on its way, or waits on it.
bool is_in_program(State state) {
  switch (state) {
    case State::kApproaching:
    case State::kRunning:
    case State::kHolding:
    case State::kHeld:
    case State::kStarving:
    case State::kStarved:
    case State::kStepping:
      return true;
    default:
      return false;
  }
}

/// The number of the tool in the spindle stands in front where it is known.
void append_tool(std::string& text, const Pose<double>& tool, const dds::Status& status) {
  const std::string number = status.tool > 0 ? std::to_string(status.tool) + ", " : "";
  append(text, "tool      %stip %.4f %.4f %.4f mm, axis %.6f %.6f %.6f, length %.3f mm\n",
         number.c_str(), tool.tip[0], tool.tip[1], tool.tip[2], tool.axis[0], tool.axis[1],
         tool.axis[2], status.tool_length_mm);
}

/// "alarm     following_error of b2, line 840".
void append_alarm(std::string& text, const dds::Status& status, const dds::MachineInfo& machine) {
  if (status.alarm == Alarm::kNone) return;
  const std::string joint = alarm_joint(status, machine);
  text += "alarm     " + std::string(record::word(status.alarm));
  if (!joint.empty()) text += " of " + joint;
  if (status.alarm_line > 0) append(text, ", line %u", status.alarm_line);
  text += "\n";
}

/// "frame     3 (vice)", of the set-up; that of the machine file goes without saying.
void append_frame(std::string& text, const dds::Status& status, const dds::MachineInfo& machine) {
  if (status.work_frame == 0) return;
  const auto row =
      std::find_if(machine.work_frames.begin(), machine.work_frames.end(),
                   [&status](const WorkFrame& frame) { return frame.number == status.work_frame; });
  const bool has_name = row != machine.work_frames.end() && row->name.front() != '\0';
  append(text, "frame     %u", status.work_frame);
  if (has_name) append(text, " (%s)", row->name.data());
  text += "\n";
}

/// Calls `report` with every joint that has soft limits, and with them.
template <class Report>
void each_soft_limit(const dds::MachineInfo& machine, const Report& report) {
  for (std::size_t i = 0; i < joint_count(machine); ++i) {
    const SoftLimits::Row& row = machine.soft_limits.rows()[i];
    if (row.is_set) report(machine.joints[i], row);
  }
}

/// "limits    b3 -40 to 42.5 mm, b4 -10 to 10 deg": the soft limits.
void append_limits(std::string& text, const dds::MachineInfo& machine) {
  const char* begin = "limits   ";
  each_soft_limit(machine, [&](const dds::JointInfo& joint, const SoftLimits::Row& row) {
    const auto shown = [&joint](double value) {
      return joint.is_rotary ? units::deg_from_rad(value) : value;
    };
    append(text, "%s %s %.10g to %.10g %s", begin, joint.name.c_str(), shown(row.min),
           shown(row.max), joint.is_rotary ? "deg" : "mm");
    begin = ",";
  });
  for (const KeepOutBox& box : machine.soft_limits.keep_out().boxes()) {
    append(text, "%s keep-out %s", begin, box.name.data());
    begin = ",";
  }
  if (const TipBox& tip = machine.soft_limits.tip_box(); tip.is_set) {
    append(text, "%s tip %.10g,%.10g,%.10g to %.10g,%.10g,%.10g mm", begin, tip.min[0], tip.min[1],
           tip.min[2], tip.max[0], tip.max[1], tip.max[2]);
  }
  if (!machine.soft_limits.empty()) text += "\n";
}

/// "probe     in contact", of a machine that has one.
void append_probe(std::string& text, const dds::Status& status) {
  if (status.probe == ProbeInput::kNone) return;
  const bool is_in_contact = status.probe == ProbeInput::kContact;
  append(text, "probe     %s\n", is_in_contact ? "in contact" : "free");
}

/// "guard     open", as long as one is.
void append_guard(std::string& text, const dds::Status& status) {
  if (status.is_guard_open) text += "guard     open: only jogging is allowed\n";
}

/// "free", as JSON has it.
const char* word_of(ProbeInput probe) {
  switch (probe) {
    case ProbeInput::kFree:
      return "free";
    case ProbeInput::kContact:
      return "contact";
    default:
      return "none";
  }
}

/// "{"vice":{"b3_mm":[-40,42.5],"b4_rad":[-0.1,0.1]}}".
std::string keep_out_json(const dds::MachineInfo& machine) {
  std::string text;
  for (const KeepOutBox& box : machine.soft_limits.keep_out().boxes()) {
    std::string joints;
    for (std::size_t i = 0; i < joint_count(machine); ++i) {
      if (!box.has(static_cast<int>(i))) continue;
      const dds::JointInfo& joint = machine.joints[i];
      if (!joints.empty()) joints += ",";
      joints += json_quoted(joint.name + (joint.is_rotary ? "_rad" : "_mm")) + ":[" +
                json_number("%.17g", box.min[i]) + "," + json_number("%.17g", box.max[i]) + "]";
    }
    if (!text.empty()) text += ",";
    text += json_quoted(box.name.data()) + ":{" + joints + "}";
  }
  return "{" + text + "}";
}

/// "[1,2,3]".
template <class Three>
std::string array_json(const Three& values) {
  std::string text = "[";
  text += json_number("%.17g", values[0]) + "," + json_number("%.17g", values[1]) + ",";
  return text + json_number("%.17g", values[2]) + "]";
}

/// "{"min_mm":[0,0,0],"max_mm":[9,9,9]}"; null where no tip box is set.
std::string tip_box_json(const dds::MachineInfo& machine) {
  const TipBox& tip = machine.soft_limits.tip_box();
  if (!tip.is_set) return "null";
  return "{\"min_mm\":" + array_json(tip.min) + ",\"max_mm\":" + array_json(tip.max) + "}";
}

/// "{"b3_mm":[-40,42.5],"b4_rad":[-0.1,0.1]}".
std::string limits_json(const dds::MachineInfo& machine) {
  std::string text;
  each_soft_limit(machine, [&](const dds::JointInfo& joint, const SoftLimits::Row& row) {
    if (!text.empty()) text += ",";
    text += json_quoted(joint.name + (joint.is_rotary ? "_rad" : "_mm")) + ":[" +
            json_number("%.17g", row.min) + "," + json_number("%.17g", row.max) + "]";
  });
  return "{" + text + "}";
}

}  // namespace

const char* text_of(State state) {
  return static_cast<int>(state) < kStateCount ? name_of(state) : "unknown";
}

std::optional<State> parse_state(const std::string& text) {
  for (int i = 0; i < kStateCount; ++i) {
    const auto state = static_cast<State>(i);
    if (::strcasecmp(text.c_str(), name_of(state)) == 0) return state;
  }
  return std::nullopt;
}

std::string all_states() {
  std::string names;
  for (int i = 0; i < kStateCount; ++i) {
    if (i > 0) names += ", ";
    names += name_of(static_cast<State>(i));
  }
  return names;
}

std::optional<TimeToGo> time_to_go(const dds::Status& status) {
  if (!is_in_program(status.state) || status.block_count == 0) return {};
  if (status.blocks_received >= status.block_count && status.blocks_queued == 0) {
    return TimeToGo{status.planned_s, true};
  }
  constexpr double kEnough = 0.005;
  const double done = static_cast<double>(status.block) / static_cast<double>(status.block_count);
  if (!(done > kEnough) || done > 1) return {};
  return TimeToGo{status.plan_time_s * (1 - done) / done, false};
}

std::string describe(const dds::Status& status, const dds::MachineInfo& machine,
                     const std::optional<Pose<double>>& tool) {
  std::string text;
  append(text, "machine   %s: %s%s%s\n", machine.name.c_str(), text_of(status.state),
         status.alarm != Alarm::kNone ? " (alarm)" : "",
         status.is_dry_run ? ", dry run: no drive moves" : "");
  append_alarm(text, status, machine);
  if (!status.message.empty()) append(text, "message   %s\n", status.message.c_str());
  if (status.session != 0) {
    append(text, "program   %s from station %s\n", status.program.c_str(), status.station.c_str());
  }
  // An alarm voids the program: where it came to rest is asked for all the same.
  if (status.session != 0 || (status.alarm != Alarm::kNone && status.line > 0)) {
    append(text, "block     %llu", Count{status.block});
    if (status.session != 0 && status.block_count > 0)
      append(text, " of %llu", Count{status.block_count});
    append(text, ", line %u\n", status.line);
  }
  if (const auto left = time_to_go(status)) {
    append(text, "to go     %s%s at 100 %%\n", left->is_planned ? "" : "about ",
           time_text(left->seconds).c_str());
  }
  append(text, "feed      %.1f of %.1f mm/min, override %.0f %%, rapid override %.0f %%%s%s\n",
         status.feed_achieved_mm_per_min, status.feed_programmed_mm_per_min,
         status.feed_override * 100, status.rapid_override * 100,
         status.is_single_block ? ", single block" : "",
         status.stops_at_optional ? ", optional stops" : "");
  if (const std::string held = held_by(status, machine); !held.empty()) {
    append(text, "held by   %s\n", held.c_str());
  }
  append_frame(text, status, machine);
  append_limits(text, machine);
  append(text, "buffer    %u blocks, %u pieces, %.2f s planned; starved %llu times\n",
         status.blocks_queued, status.pieces_queued, status.planned_s, Count{status.starvations});
  append(text, "joints   ");
  for (std::size_t i = 0; i < joint_count(machine); ++i) {
    const dds::JointInfo& joint = machine.joints[i];
    append(text, " %s %.4f %s", joint.name.c_str(),
           joint.is_rotary ? units::deg_from_rad(status.joints[i]) : status.joints[i],
           joint.is_rotary ? "deg" : "mm");
  }
  text += "\n";
  if (tool) append_tool(text, *tool, status);
  append_probe(text, status);
  append_guard(text, status);
  append(text, "cycles    %llu run, %llu lost; %s, %s\n", Count{status.cycles_run},
         Count{status.periods_lost},
         status.realtime_mode == dds::RealtimeMode::kEnforced ? "real time" : "best effort",
         status.is_secured        ? "secured"
         : status.is_open_network ? "OPEN NETWORK, unsecured"
                                  : "open");
  if (status.is_enabling_required || status.enabling_devices > 0) {
    append(text, "enabling  %u devices pressed%s\n", status.enabling_devices,
           status.is_enabling_required ? ", required to move" : "");
  }
  if (!status.stalled_reader.empty()) {
    append(text, "stalled   %s\n", status.stalled_reader.c_str());
  }
  if (status.commands_dropped + status.replies_dropped > 0) {
    append(text, "dropped   %llu commands, %llu replies\n", Count{status.commands_dropped},
           Count{status.replies_dropped});
  }
  if (status.is_auxiliary_ignored) append(text, "actions   ignored (auxiliary = \"ignore\")\n");
  append(text, "batches   %llu dropped, %llu asked for again\n", Count{status.batches_dropped},
         Count{status.batches_lost});
  return text;
}

std::string to_json(const dds::Status& status, const dds::MachineInfo& machine,
                    const std::optional<Pose<double>>& tool) {
  std::string text = "{";
  append(text, "\"machine\":%s,", json_quoted(machine.name).c_str());
  append(text, "\"state\":\"%s\",\"alarm\":%d,\"epoch\":%u,\"status_sequence\":%llu,",
         text_of(status.state), static_cast<int>(status.alarm), status.epoch,
         Count{status.status_sequence});
  append(text, "\"alarm_name\":\"%s\",\"alarm_joint\":%s,\"alarm_line\":%u,",
         std::string(record::word(status.alarm)).c_str(),
         json_quoted(alarm_joint(status, machine)).c_str(),
         status.alarm != Alarm::kNone ? status.alarm_line : 0);
  append(text, "\"work_frame\":%u,\"tool\":%u,", status.work_frame, status.tool);
  text += "\"soft_limits\":" + limits_json(machine) + ",";
  text += "\"keep_out\":" + keep_out_json(machine) + ",";
  text += "\"tip_box\":" + tip_box_json(machine) + ",";
  append(text, "\"probe\":\"%s\",\"contacts\":%u,", word_of(status.probe), status.contacts);
  append(text, "\"guard_open\":%s,", status.is_guard_open ? "true" : "false");
  append(text, "\"program\":%s,", json_quoted(status.program).c_str());
  append(text, "\"station\":%s,", json_quoted(status.station).c_str());
  append(text,
         "\"block\":%llu,\"block_count\":%llu,\"line\":%u,\"blocks_received\":%llu,"
         "\"blocks_done\":%llu,\"blocks_queued\":%u,",
         Count{status.block}, Count{status.block_count}, status.line, Count{status.blocks_received},
         Count{status.blocks_done}, status.blocks_queued);
  const auto add = [&text](const std::string& name, const char* format, double value) {
    text += json_quoted(name) + ":" + json_number(format, value) + ",";
  };
  add("tool_length_mm", "%.6f", status.tool_length_mm);
  add("planned_s", "%.3f", status.planned_s);
  add("feed_programmed_mm_per_min", "%.6g", status.feed_programmed_mm_per_min);
  add("feed_achieved_mm_per_min", "%.6g", status.feed_achieved_mm_per_min);
  add("feed_override", "%.6g", status.feed_override);
  add("rapid_override", "%.6g", status.rapid_override);
  append(text, "\"single_block\":%s,\"optional_stop\":%s,\"dry_run\":%s,",
         status.is_single_block ? "true" : "false", status.stops_at_optional ? "true" : "false",
         status.is_dry_run ? "true" : "false");
  add("plan_time_s", "%.6f", status.plan_time_s);
  append(text,
         "\"cycles_run\":%llu,\"periods_lost\":%llu,\"starvations\":%llu,"
         "\"batches_dropped\":%llu,\"batches_lost\":%llu,\"records_overrun\":%llu,"
         "\"setpoints_overrun\":%llu,",
         Count{status.cycles_run}, Count{status.periods_lost}, Count{status.starvations},
         Count{status.batches_dropped}, Count{status.batches_lost}, Count{status.records_overrun},
         Count{status.setpoints_overrun});
  append(text, "\"realtime\":\"%s\",\"secured\":%s,",
         status.realtime_mode == dds::RealtimeMode::kEnforced ? "enforced" : "best_effort",
         status.is_secured ? "true" : "false");
  append(text,
         "\"open_network\":%s,\"enabling_required\":%s,\"enabling_devices\":%u,"
         "\"commands_dropped\":%llu,\"replies_dropped\":%llu,\"stalled_reader\":%s,",
         status.is_open_network ? "true" : "false", status.is_enabling_required ? "true" : "false",
         status.enabling_devices, Count{status.commands_dropped}, Count{status.replies_dropped},
         json_quoted(status.stalled_reader).c_str());
  for (std::size_t i = 0; i < joint_count(machine); ++i) {
    const dds::JointInfo& joint = machine.joints[i];
    add(joint.name + (joint.is_rotary ? "_rad" : "_mm"), "%.17g", status.joints[i]);
  }
  append(text, "\"limiting\":%s,", json_quoted(held_by(status, machine)).c_str());
  text += "\"tip_mm\":" + (tool ? array_json(tool->tip) : "null") + ",";
  text += "\"tool_axis\":" + (tool ? array_json(tool->axis) : "null") + ",";
  append(text, "\"message\":%s}", json_quoted(status.message).c_str());
  return text;
}

}  // namespace meridian::cli
