// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/diagnostics.hpp"

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::bridge {
namespace {

[[nodiscard]] std::string number(double value) {
  std::string out;
  text::append(out, "%.6g", value);
  return out;
}

[[nodiscard]] Diagnosis program_of(const dds::Status& status) {
  Diagnosis out{.name = "program"};
  const bool has_alarm = status.alarm != Alarm::kNone;
  out.level = is_fault(status.state) ? Level::kError : has_alarm ? Level::kWarning : Level::kOk;
  out.message = record::word(status.state);
  if (has_alarm) out.message.append(": ").append(record::word(status.alarm));
  out.values = {{"state", std::string(record::word(status.state))},
                {"alarm", std::string(record::word(status.alarm))},
                {"program", status.program},
                {"line", std::to_string(status.line)},
                {"feed mm/min", number(status.feed_achieved_mm_per_min)},
                {"feed override", number(status.feed_override)},
                {"blocks done", std::to_string(status.blocks_done)},
                {"message", status.message}};
  return out;
}

[[nodiscard]] Diagnosis drives_of(const MachineModel& model, const DrivePositions& drives) {
  Diagnosis out{.name = "drives", .message = "all report"};
  for (int i = 0; i < model.joint_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::uint16_t statusword = drives.statusword(at);
    std::string shown(record::drive_state_word(statusword));
    const bool is_silent = statusword == 0, is_fault = drives.error(at) != 0;
    if (is_fault) text::append(shown, ", %04Xh", static_cast<unsigned>(drives.error(at)));
    const std::string name = drive_spec(model, i).name;
    if (is_fault || (is_silent && out.level == Level::kOk)) out.message = name + ": " + shown;
    if (is_silent && out.level == Level::kOk) out.level = Level::kWarning;
    if (is_fault) out.level = Level::kError;
    out.values.emplace_back(name, shown);
  }
  return out;
}

[[nodiscard]] Diagnosis realtime_of(const dds::Status& status) {
  Diagnosis out{.name = "real time", .message = "enforced"};
  if (status.realtime_mode != dds::RealtimeMode::kEnforced) {
    out.level = Level::kWarning;
    out.message = "best effort";
  }
  out.values = {{"cycles", std::to_string(status.cycles_run)},
                {"periods lost", std::to_string(status.periods_lost)},
                {"starvations", std::to_string(status.starvations)},
                {"setpoints overrun", std::to_string(status.setpoints_overrun)}};
  return out;
}

}  // namespace

std::vector<Diagnosis> diagnose(const MachineModel& model, const dds::Status* status,
                                const DrivePositions& drives) {
  if (status == nullptr) {
    return {{.level = Level::kStale, .name = "program", .message = "the service says nothing"}};
  }
  return {program_of(*status), drives_of(model, drives), realtime_of(*status)};
}

void put_diagnostics(ros::Cdr& message, std::int64_t time_ns, const std::string& machine,
                     const std::vector<Diagnosis>& all) {
  message.begin().put_header(time_ns, "").put_count(all.size());
  for (const Diagnosis& one : all) {
    message.put(static_cast<std::uint8_t>(one.level)).put("meridian: " + one.name);
    message.put(one.message).put(machine).put_count(one.values.size());
    for (const auto& [key, value] : one.values) message.put(key).put(value);
  }
}

}  // namespace meridian::bridge
