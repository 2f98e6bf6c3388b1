// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/flight/flight_report.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/recording/record/file/recorded/sent_positions.hpp"
#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::record {
namespace {

using text::append;
using text::Count;

template <class Use>
[[nodiscard]] std::optional<RecordError> for_each_row(RecordingReader& recording, Use&& use) {
  recording.rewind();
  RecordingRow row;
  for (;;) {
    const auto read = recording.next(row);
    if (!read) return read.error();
    if (!*read) return std::nullopt;
    use(row);
  }
}

/// Finds the row of the alarm, and how far the recording reaches.
class Finder {
 public:
  explicit Finder(FlightReport& report) : report_(report) {}

  void look(const RecordingRow& row) {
    if (report_.rows++ == 0) {
      first_ns_ = due_ns_ = row.due_ns;
      report_.cycle = row.cycle;
    } else if (row.cycle > last_.cycle) {
      report_.missing += row.cycle - last_.cycle - 1;
    }
    if (row.alarm != Alarm::kNone && report_.alarm == Alarm::kNone) {
      report_.alarm = row.alarm;
      report_.is_dry_run = (row.flags & kSetpointDry) != 0;
      report_.joint = row.alarm_joint;
      report_.cycle = row.cycle;
      report_.line = row.line;
      report_.block = row.sequence;
      report_.state = report_.rows > 1 ? last_.state : row.state;
      due_ns_ = row.due_ns;
    }
    if (row.state == State::kFaultStop) ++stop_rows_;
    last_ = row;
  }

  void finish(const MachineModel& model) {
    report_.before_s = 1e-9 * static_cast<double>(due_ns_ - first_ns_);
    report_.after_s = 1e-9 * static_cast<double>(last_.due_ns - due_ns_);
    report_.stop_s =
        1e-9 * static_cast<double>(static_cast<std::int64_t>(stop_rows_) * model.cycle_ns);
  }
  [[nodiscard]] std::int64_t due_ns() const noexcept { return due_ns_; }

 private:
  FlightReport& report_;
  RecordingRow last_;
  std::int64_t first_ns_ = 0, due_ns_ = 0;
  std::uint64_t stop_rows_ = 0;
};

/// Watches what the drives say, with times from `zero_ns`.
class DriveLook {
 public:
  DriveLook(FlightReport& report, const MachineModel& model, std::int64_t zero_ns)
      : report_(report), model_(model), zero_ns_(zero_ns) {}

  void look(const RecordingRow& row) {
    const double at_s = 1e-9 * static_cast<double>(row.due_ns - zero_ns_);
    look_at_words(row, at_s);
    if (row.is_emergency_stop && !report_.is_emergency) {
      report_.is_emergency = true;
      report_.emergency_at_s = at_s;
    }
    const double age_s = 1e-9 * static_cast<double>(row.feedback_age_ns);
    if (age_s > report_.oldest_feedback_s) {
      report_.oldest_feedback_s = age_s;
      report_.oldest_at_s = at_s;
    }
    sent_.note(row, model_);
    if ((row.flags & kSetpointEnabled) != 0) look_at_following(row);
  }

 private:
  void look_at_words(const RecordingRow& row, double at_s) {
    for (int i = 0; i < model_.joint_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const bool is_same = drive_state_word(row.statusword[n]) == drive_state_word(words_[n]) &&
                           row.drive_error[n] == errors_[n];
      if (has_words_ && !is_same && report_.turns.size() < FlightReport::kMaxTurns) {
        report_.turns.push_back({i, at_s, words_[n], row.statusword[n], row.drive_error[n]});
      }
    }
    words_ = row.statusword;
    errors_ = row.drive_error;
    has_words_ = true;
  }

  void look_at_following(const RecordingRow& row) {
    const JointVector* const seen = sent_.seen_by(row);
    if (seen == nullptr) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(model_.joint_count); ++i) {
      const double error = row.feedback[i] - (*seen)[i];
      Following& following = report_.following[i];
      if (row.cycle == report_.cycle) following.at_alarm = error;
      const bool is_before = report_.alarm == Alarm::kNone || row.cycle < report_.cycle;
      double& worst = is_before ? following.before : following.after;
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
  }

  FlightReport& report_;
  const MachineModel& model_;
  std::int64_t zero_ns_;
  std::array<std::uint16_t, kMaxJoints> words_{}, errors_{};
  bool has_words_ = false;
  SentPositions sent_;
};

[[nodiscard]] double as_read(const JointSpec& spec, double value) {
  return spec.is_rotary ? units::deg_from_rad(value) : value;
}

}  // namespace

Expected<FlightReport, RecordError> read_flight(RecordingReader& recording,
                                                const MachineModel& model) {
  if (!recording.has_feedback()) {
    return tl::make_unexpected(
        RecordError{recording.path(), 1, "it holds no feedback of the drives",
                    "name a file of the flight recorder, or of meridian record"});
  }
  FlightReport report;
  Finder finder(report);
  if (auto error = for_each_row(recording, [&](const auto& row) { finder.look(row); })) {
    return tl::make_unexpected(std::move(*error));
  }
  if (report.rows == 0) {
    return tl::make_unexpected(RecordError{recording.path(), 0, "no cycle is in it", ""});
  }
  finder.finish(model);
  const auto drives = std::make_unique<DriveLook>(report, model, finder.due_ns());
  if (auto error = for_each_row(recording, [&](const auto& row) { drives->look(row); })) {
    return tl::make_unexpected(std::move(*error));
  }
  return report;
}

std::string to_text(const FlightReport& report, const MachineModel& model) {
  std::string text;
  if (report.alarm == Alarm::kNone) {
    append(text, "alarm      none\n");
  } else {
    append(text, "alarm      %s", std::string(word(report.alarm)).c_str());
    if (report.joint >= 0) append(text, " of %s", limited_spec(model, report.joint).name.c_str());
    append(text, " in cycle %llu, block %llu of line %u, %s before\n", Count{report.cycle},
           Count{report.block}, report.line, name_of(report.state));
  }
  if (report.is_dry_run) text += "dry run    no drive followed\n";
  append(text, "kept       %.3f s before it, %.3f s after; %llu cycles, %llu missing\n",
         report.before_s, report.after_s, Count{report.rows}, Count{report.missing});
  if (report.stop_s > 0) append(text, "stop       FaultStop for %.3f s\n", report.stop_s);
  if (report.is_emergency) {
    append(text, "emergency  the input opened at %+.3f s\n", report.emergency_at_s);
  }
  append(text, "feedback   oldest %.1f ms, at %+.3f s\n", 1e3 * report.oldest_feedback_s,
         report.oldest_at_s);
  append(text, "following  %-10s %12s %12s %12s %12s\n", "drive", "before", "at alarm", "behind",
         "allowed");
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& drive = drive_spec(model, i);
    const Following& error = report.following[static_cast<std::size_t>(i)];
    append(text, "           %-10s %12.5f %12.5f %12.5f %12.5g %s\n", drive.name.c_str(),
           as_read(drive, error.before), as_read(drive, error.at_alarm),
           as_read(drive, error.after), as_read(drive, drive.limits.following_error),
           drive.is_rotary ? "deg" : "mm");
  }
  for (const DriveTurn& turn : report.turns) {
    append(text, "drive      %+9.3f s  %s: %s -> %s", turn.at_s,
           drive_spec(model, turn.drive).name.c_str(),
           std::string(drive_state_word(turn.from)).c_str(),
           std::string(drive_state_word(turn.to)).c_str());
    append(text, " (%04Xh", turn.to);
    if (turn.error != 0) append(text, ", error %04Xh", turn.error);
    text += ")\n";
  }
  return text;
}

}  // namespace meridian::record
