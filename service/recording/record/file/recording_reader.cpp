// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recording_reader.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "service/recording/record/file/mapped_file.hpp"
#include "service/recording/record/file/recording_column.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::record {
namespace {

/// Cuts the first `separator`-ended part off `text`.
[[nodiscard]] std::string_view cut(std::string_view& text, char separator) noexcept {
  const void* found = text.empty() ? nullptr : std::memchr(text.data(), separator, text.size());
  const std::size_t length =
      found != nullptr ? static_cast<std::size_t>(static_cast<const char*>(found) - text.data())
                       : text.size();
  const std::string_view part = text.substr(0, length);
  text.remove_prefix(found != nullptr ? length + 1 : length);
  return part;
}

[[nodiscard]] std::string_view cut_line(std::string_view& text) noexcept {
  std::string_view line = cut(text, '\n');
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace

class RecordingReader::Impl {
 public:
  MappedFile file;
  std::string path;
  std::vector<Column> columns;
  std::string_view rest;
  std::string_view first_row;
  std::uint64_t line = 1;
  bool has_velocity = false, has_plan_time = false, has_feedback = false;
  bool has_state = false, has_alarm = false, has_statuswords = false;
  std::vector<std::string> names;  ///< of limited.hpp
  ActuatorStage stage;
  int joint_count = 0;
  bool has_joints = true, has_drives = true;  ///< columns of the stage's joints, of its drives

  /// Fills in joints from drives, or drives from joints.
  void complete(RecordingRow& row) const noexcept {
    std::copy_n(row.positions.begin(), joint_count, row.joints.begin());
    if (stage.kind == StageKind::kIdentity) return;
    double* const drives = row.positions.data() + joint_count;
    if (!has_joints) {
      JointVector u = row.joints;
      u[stage.linear_joint] = drives[0];
      u[stage.rotary_joint] = drives[1];
      row.joints = stage::joints_of(stage, u);
      std::copy_n(row.joints.begin(), joint_count, row.positions.begin());
    } else if (!has_drives) {
      const JointVector u = stage::drives_of(stage, row.joints);
      drives[0] = u[stage.linear_joint];
      drives[1] = u[stage.rotary_joint];
    }
  }

  [[nodiscard]] RecordError error(std::uint64_t at, std::string message, std::string remedy) const {
    return {path, at, std::move(message), std::move(remedy)};
  }

  [[nodiscard]] std::optional<RecordError> read_header(const MachineModel& model) {
    rest = file.text();
    std::string_view header = cut_line(rest);
    first_row = rest;
    bool has_cycle = false, has_due = false;
    std::uint32_t positions = 0, velocities = 0, feedbacks = 0, statuswords = 0;
    bool has_feedback_cycle = false, has_kind = false, has_rate = false, has_sequence = false;
    for (int i = 0; i < limited_count(model); ++i) names.push_back(limited_spec(model, i).name);
    while (!header.empty()) {
      columns.push_back(find_column(cut(header, ','), model));
      const Column& column = columns.back();
      has_cycle |= column.field == Field::kCycle;
      has_due |= column.field == Field::kDue;
      has_plan_time |= column.field == Field::kPlanTime;
      if (column.field == Field::kPosition) positions |= 1U << column.index;
      if (column.field == Field::kVelocity) velocities |= 1U << column.index;
      if (column.field == Field::kFeedback) feedbacks |= 1U << column.index;
      if (column.field == Field::kStatusword) statuswords |= 1U << column.index;
      has_state |= column.field == Field::kState;
      has_kind |= column.field == Field::kKind;
      has_rate |= column.field == Field::kRate;
      has_sequence |= column.field == Field::kSequence;
      has_alarm |= column.field == Field::kAlarm;
      has_feedback_cycle |= column.field == Field::kFeedbackCycle;
    }
    const std::string remedy =
        "name a recording of machine '" + model.name + "' (docs/recordings.md)";
    if (!has_cycle || !has_due) {
      return error(1, "no recording: the header has no column 'cycle' or 'due_ns'", remedy);
    }
    const std::uint32_t all = (1U << limited_count(model)) - 1U;
    const std::uint32_t joints = (1U << model.joint_count) - 1U;
    joint_count = model.joint_count;
    if (has_stage(model)) {
      stage = model.stage;
      has_drives = (positions & ~joints) == (all & ~joints);
      const std::uint32_t carried = (1U << stage.linear_joint) | (1U << stage.rotary_joint);
      has_joints = (positions & carried) == carried;
      if (has_drives) positions |= carried;
    }
    for (int i = 0; i < model.joint_count; ++i) {
      if ((positions & (1U << i)) != 0) continue;
      return error(1, "the header has no column '" + position_column(model.joints[i]) + "'",
                   remedy);
    }
    has_velocity = velocities == all;
    has_feedback = has_feedback_cycle && feedbacks == joints;
    has_statuswords = has_feedback && statuswords == joints;
    has_state = has_state && has_kind && has_rate && has_sequence;
    return std::nullopt;
  }
};

RecordingReader::RecordingReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordingReader::~RecordingReader() = default;
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;

Expected<RecordingReader, RecordError> RecordingReader::open(const std::string& path,
                                                             const MachineModel& model) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  if (const int error = impl->file.open(path); error != 0) {
    return tl::make_unexpected(RecordError{
        path, 0, std::string("cannot be read: ") + std::strerror(error), "check the name"});
  }
  if (auto error = impl->read_header(model)) return tl::make_unexpected(std::move(*error));
  return RecordingReader(std::move(impl));
}

Expected<bool, RecordError> RecordingReader::next(RecordingRow& row) {
  if (impl_->rest.empty()) return false;
  ++impl_->line;
  std::string_view text = cut_line(impl_->rest);
  if (text.empty() && impl_->rest.empty()) return false;
  std::size_t count = 0;
  for (const Column& column : impl_->columns) {
    if (text.empty()) break;
    ++count;
    const std::string_view field = cut(text, ',');
    if (read_field(column, field, impl_->names, row)) continue;
    return tl::make_unexpected(impl_->error(
        impl_->line,
        "column '" + column.name + "' holds '" + std::string(field.substr(0, 40)) + "'",
        "the row is damaged: record again"));
  }
  if (count != impl_->columns.size() || !text.empty()) {
    return tl::make_unexpected(impl_->error(impl_->line,
                                            "the row has not as many columns as the header",
                                            "the recording was cut off or edited: record again"));
  }
  impl_->complete(row);
  return true;
}

void RecordingReader::rewind() noexcept {
  impl_->rest = impl_->first_row;
  impl_->line = 1;
}

bool RecordingReader::has_velocity() const noexcept { return impl_->has_velocity; }
bool RecordingReader::has_plan_time() const noexcept { return impl_->has_plan_time; }
bool RecordingReader::has_state() const noexcept { return impl_->has_state; }
bool RecordingReader::has_alarm() const noexcept { return impl_->has_alarm; }
bool RecordingReader::has_statuswords() const noexcept { return impl_->has_statuswords; }
bool RecordingReader::has_feedback() const noexcept { return impl_->has_feedback; }
const std::string& RecordingReader::path() const noexcept { return impl_->path; }

}  // namespace meridian::record
