// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/panel/json_text.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

[[nodiscard]] const char* state_name(State state) {
  return static_cast<int>(state) < kStateCount ? name_of(state) : "unknown";
}

/// So many digits as a picture or a display can use: 1e-7 mm.
[[nodiscard]] double rounded(double value) { return std::round(value * 1e7) * 1e-7; }

[[nodiscard]] json to_json(const JointVector& joints, int count) {
  json out = json::array();
  for (int i = 0; i < count; ++i) out.push_back(joints[static_cast<std::size_t>(i)]);
  return out;
}

[[nodiscard]] json trail_json(const Motion& motion) {
  json out = json::array();
  for (const Motion::TrailPoint& point : motion.trail()) {
    const auto& [tip, axis] = point.pose;
    out.push_back({rounded(tip[0]), rounded(tip[1]), rounded(tip[2]), rounded(axis[0]),
                   rounded(axis[1]), rounded(axis[2]), point.line});
  }
  return out;
}

[[nodiscard]] json samples_json(const Motion& motion, int count) {
  json out = json::array();
  for (const Motion::Sample& sample : motion.samples()) {
    json row = json::array({sample.cycle});
    for (int i = 0; i < count; ++i) row.push_back(sample.joints[static_cast<std::size_t>(i)]);
    for (int i = 0; i < count; ++i) {
      row.push_back(rounded(sample.following[static_cast<std::size_t>(i)]));
    }
    row.push_back(rounded(60 * sample.feed_mm_per_s));
    out.push_back(std::move(row));
  }
  return out;
}

[[nodiscard]] json shares_json(const Motion& motion, int count) {
  json out = json::array();
  for (int i = 0; i < count; ++i) out.push_back(motion.shares()[static_cast<std::size_t>(i)]);
  return out;
}

/// The joint, or drive of the stage, that limits the feed; empty: none does.
[[nodiscard]] std::string held_by(const dds::Status& status, const MachineModel& model) {
  const bool is_known = status.limiting_joint >= 0 && status.limiting_joint < limited_count(model);
  return is_known ? limited_spec(model, status.limiting_joint).name : "";
}

[[nodiscard]] json alarm_json(const dds::Status& status, const MachineModel& model) {
  if (status.alarm == Alarm::kNone) return nullptr;
  return {{"name", record::word(status.alarm)},
          {"line", status.alarm_line},
          {"text", alarm_text(status, model)}};
}

/// What the machine's table of verbs lets an operator ask for in this state; what that table cannot
/// hold may still be refused.
[[nodiscard]] json allowed_json(State state) {
  json out = json::array();
  for (int i = 0; i < kVerbCount && static_cast<int>(state) < kStateCount; ++i) {
    const auto verb = static_cast<Verb>(i);
    const Effect effect = effect_of(state, verb).effect;
    if (effect == Effect::kGo || effect == Effect::kSet) out.push_back(name_of(verb));
  }
  return out;
}

void add_program(json& out, const dds::Status& status) {
  out["session"] = status.session != 0;
  out["program"] = status.program;
  out["station"] = status.station;
  out["block"] = status.block;
  out["block_count"] = status.block_count;
  out["line"] = status.line;
  out["blocks_done"] = status.blocks_done;
  out["blocks_queued"] = status.blocks_queued;
  out["pieces_queued"] = status.pieces_queued;
  out["planned_s"] = status.planned_s;
  out["plan_time_s"] = status.plan_time_s;
  out["motion"] = record::word(status.motion);
  out["single_block"] = status.is_single_block;
  out["optional_stop"] = status.stops_at_optional;
  out["dry_run"] = status.is_dry_run;
}

void add_health(json& out, const dds::Status& status) {
  out["realtime"] = status.realtime_mode == dds::RealtimeMode::kEnforced;
  out["secured"] = status.is_secured;
  out["open_network"] = status.is_open_network;
  out["enabling_required"] = status.is_enabling_required;
  out["enabling_devices"] = status.enabling_devices;
  out["guard_open"] = status.is_guard_open;
  out["auxiliary_ignored"] = status.is_auxiliary_ignored;
  out["cycles"] = status.cycles_run;
  out["periods_lost"] = status.periods_lost;
  out["starvations"] = status.starvations;
  out["stalled"] = status.stalled_reader;
  out["enabled_mask"] = status.drives_enabled_mask;
  out["fault_mask"] = status.drives_fault_mask;
}

void add_motion(json& out, const dds::Status& status, const MachineModel& model,
                const Motion& motion) {
  const Pose<double> pose = forward(model, status.tool_length_mm, status.joints);
  out["tip"] = pose.tip;
  out["axis"] = pose.axis;
  out["joints"] = to_json(status.joints, model.joint_count);
  out["now"] = motion.joints() ? to_json(*motion.joints(), model.joint_count) : json(nullptr);
  out["following"] = to_json(motion.following(), model.joint_count);
  out["shares"] = shares_json(motion, model.joint_count);
  out["trail"] = trail_json(motion);
  out["samples"] = samples_json(motion, model.joint_count);
}

[[nodiscard]] json bare_frame(const dds::Status& status, const MachineModel& names,
                              const Auxiliaries& auxiliaries) {
  // 64-bit numbers as text: a page has doubles.
  json out = {{"t", "frame"},
              {"service", std::to_string(status.service_id)},
              {"sequence", status.status_sequence},
              {"epoch", status.epoch},
              {"state", state_name(status.state)},
              {"alarm", alarm_json(status, names)},
              {"message", status.message},
              {"tool_length", status.tool_length_mm},
              {"tool", status.tool},
              {"work_frame", status.work_frame},
              {"spindle", auxiliaries.spindle()},
              {"coolant", auxiliaries.coolant()},
              {"waits_for", auxiliaries.waits_for()},
              {"feed_programmed", status.feed_programmed_mm_per_min},
              {"feed_achieved", status.feed_achieved_mm_per_min},
              {"feed_override", status.feed_override},
              {"rapid_override", status.rapid_override},
              {"limiting", held_by(status, names)},
              {"at_pole", status.is_at_pole},
              {"branch", status.branch}};
  out["can"] = allowed_json(status.state);
  add_program(out, status);
  add_health(out, status);
  return out;
}

}  // namespace

std::string frame_text(const dds::Status& status, const MachineModel& model, const Motion& motion,
                       const Auxiliaries& auxiliaries) {
  json out = bare_frame(status, model, auxiliaries);
  add_motion(out, status, model, motion);
  return json_text(out);
}

std::string bare_frame_text(const dds::Status& status, const MachineModel& names,
                            const Auxiliaries& auxiliaries) {
  return json_text(bare_frame(status, names, auxiliaries));
}

std::string news_text(const News& news) {
  static constexpr std::array<const char*, 3> kSources{"machine", "operator", "station"};
  json items = json::array();
  for (const NewsItem& item : news.items()) {
    const auto since = item.time.time_since_epoch();
    items.push_back(
        {{"number", item.number},
         {"time_ms", std::chrono::duration_cast<std::chrono::milliseconds>(since).count()},
         {"severity", static_cast<int>(item.severity)},
         {"source", kSources.at(static_cast<std::size_t>(item.source))},
         {"text", item.text}});
  }
  return json_text({{"t", "news"}, {"items", items}});
}

std::string machine_text(const dds::MachineInfo& machine, const std::string& scene) {
  const json out = {{"t", "machine"},
                    {"scene", scene.empty() ? json(nullptr) : json::parse(scene)},
                    {"name", machine.name},
                    {"host", machine.host},
                    {"version", machine.service_version}};
  return json_text(out);
}

std::string silent_text() { return R"({"t":"silent"})"; }

}  // namespace meridian::panel
