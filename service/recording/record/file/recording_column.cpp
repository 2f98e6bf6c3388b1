// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recording_column.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "service/recording/record/words.hpp"
#include "service/text/number.hpp"

namespace meridian::record {
namespace {

template <class Number>
[[nodiscard]] bool parse(std::string_view text, Number& value) noexcept {
  if constexpr (std::is_floating_point_v<Number>) return text::read_finite(text, value);
  return text::read_number(text, value);
}

template <class Word>
[[nodiscard]] bool take(const std::optional<Word>& found, Word& value) noexcept {
  if (found) value = *found;
  return found.has_value();
}

/// Finds the place of a joint by its name; "none" is -1.
[[nodiscard]] bool find_index(const std::vector<std::string>& names, std::string_view wanted,
                              int& index) noexcept {
  const auto found = std::find(names.begin(), names.end(), wanted);
  index = found != names.end() ? static_cast<int>(found - names.begin()) : -1;
  return index >= 0 || wanted == "none";
}

}  // namespace

Column find_column(std::string_view name, const MachineModel& model) {
  static constexpr std::pair<std::string_view, Field> kNames[] = {
      {"cycle", Field::kCycle},
      {"due_ns", Field::kDue},
      {"line", Field::kLine},
      {"kind", Field::kKind},
      {"sequence", Field::kSequence},
      {"state", Field::kState},
      {"plan_time_s", Field::kPlanTime},
      {"rate", Field::kRate},
      {"epoch", Field::kEpoch},
      {"flags", Field::kFlags},
      {"lateness_ns", Field::kLateness},
      {"computation_ns", Field::kComputation},
      {"feedback_cycle", Field::kFeedbackCycle},
      {"feedback_age_ns", Field::kFeedbackAge},
      {"emergency_stop", Field::kEmergencyStop},
      {"alarm", Field::kAlarm},
      {"alarm_joint", Field::kAlarmJoint}};
  for (const auto& [known, field] : kNames) {
    if (name == known) return {field, 0, std::string(name)};
  }
  for (int i = 0; i < limited_count(model); ++i) {
    const JointSpec& spec = limited_spec(model, i);
    if (name == position_column(spec)) return {Field::kPosition, i, std::string(name)};
    if (name == velocity_column(spec)) return {Field::kVelocity, i, std::string(name)};
  }
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& drive = drive_spec(model, i);
    if (name == feedback_column(drive)) return {Field::kFeedback, i, std::string(name)};
    if (name == statusword_column(drive)) return {Field::kStatusword, i, std::string(name)};
    if (name == drive_error_column(drive)) return {Field::kDriveError, i, std::string(name)};
  }
  return {Field::kSkip, 0, std::string(name)};
}

bool read_field(const Column& column, std::string_view text, const std::vector<std::string>& names,
                RecordingRow& row) {
  const auto index = static_cast<std::size_t>(column.index);
  switch (column.field) {
    case Field::kSkip:
      return true;
    case Field::kCycle:
      return parse(text, row.cycle);
    case Field::kDue:
      return parse(text, row.due_ns);
    case Field::kLine:
      return parse(text, row.line);
    case Field::kKind:
      return take(find_motion_kind(text), row.kind);
    case Field::kPosition:
      return parse(text, row.positions[column.index]);
    case Field::kVelocity:
      return parse(text, row.velocity[column.index]);
    case Field::kSequence:
      return parse(text, row.sequence);
    case Field::kState:
      return take(find_state(text), row.state);
    case Field::kPlanTime:
      return parse(text, row.plan_time_s);
    case Field::kRate:
      return parse(text, row.rate);
    case Field::kEpoch:
      return parse(text, row.epoch);
    case Field::kFlags:
      return parse(text, row.flags);
    case Field::kLateness:
      return parse(text, row.lateness_ns);
    case Field::kComputation:
      return parse(text, row.computation_ns);
    case Field::kFeedback:
      return text::read_number(text, row.feedback[index]);
    case Field::kFeedbackCycle:
      return parse(text, row.feedback_cycle);
    case Field::kFeedbackAge:
      return parse(text, row.feedback_age_ns);
    case Field::kStatusword:
      return parse(text, row.statusword[index]);
    case Field::kDriveError:
      return parse(text, row.drive_error[index]);
    case Field::kEmergencyStop:
      row.is_emergency_stop = text == "1";
      return row.is_emergency_stop || text == "0";
    case Field::kAlarm:
      return take(find_alarm(text), row.alarm);
    case Field::kAlarmJoint:
      return find_index(names, text, row.alarm_joint);
  }
  return false;
}

}  // namespace meridian::record
