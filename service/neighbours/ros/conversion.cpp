// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/conversion.hpp"

#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "service/neighbours/ros/events_file.hpp"
#include "service/neighbours/ros/motion_file.hpp"
#include "service/recording/record/file/recorded/operator_events_writer.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/text/printed.hpp"

namespace meridian::ros {
namespace {

using record::RecordError;
using record::RecordingReader;
using record::RecordingRow;

[[nodiscard]] Contents contents_of(const RecordingReader& recording) {
  return {.has_velocity = recording.has_velocity(),
          .has_state = recording.has_state(),
          .has_alarm = recording.has_alarm(),
          .has_feedback = recording.has_feedback(),
          .has_statuswords = recording.has_statuswords()};
}

/// Puts the events of the file beside the recording between its rows.
class EventMerge {
 public:
  EventMerge(const std::string& path, MotionFile& file, std::int64_t cycle_ns)
      : events_(path), file_(file), cycle_ns_(cycle_ns) {}

  /// Writes the events of the cycles up to the row's.
  [[nodiscard]] std::optional<RecordError> write_up_to(const RecordingRow& row) {
    for (;;) {
      if (auto error = look()) return error;
      if (!next_ || (!next_->is_incomplete && next_->cycle > row.cycle)) return std::nullopt;
      write(row);
    }
  }
  /// Writes those after the last row.
  [[nodiscard]] std::optional<RecordError> write_rest(const RecordingRow& last) {
    for (;;) {
      if (auto error = look()) return error;
      if (!next_) return std::nullopt;
      write(last);
    }
  }

 private:
  /// Makes `next_` the row to write next; nothing after the last one.
  [[nodiscard]] std::optional<RecordError> look() {
    if (next_) return std::nullopt;
    auto read = events_.next();
    if (!read) return read.error();
    next_ = std::move(*read);
    return std::nullopt;
  }
  void write(const RecordingRow& row) {
    if (next_->is_incomplete) {
      file_.write_event(row.due_ns, Level::kWarning, "operator", "events are missing");
    } else {
      file_.write_event(time_of(next_->cycle, row), Level::kInfo, "operator", next_->text);
    }
    next_.reset();
  }

  /// When that cycle was due, by the row; the row's time where that is none.
  [[nodiscard]] std::int64_t time_of(std::uint64_t cycle, const RecordingRow& row) const {
    const auto cycles = static_cast<double>(static_cast<std::int64_t>(cycle - row.cycle));
    const double time_ns =
        static_cast<double>(row.due_ns) + cycles * static_cast<double>(cycle_ns_);
    if (std::abs(time_ns) > 4e18) return row.due_ns;
    const std::int64_t at = row.due_ns + static_cast<std::int64_t>(cycle - row.cycle) * cycle_ns_;
    return MotionFile::has_time(at) ? at : row.due_ns;
  }

  EventsFile events_;
  MotionFile& file_;
  std::int64_t cycle_ns_;
  std::optional<EventsRow> next_;
};

/// What is wrong with the two names, before the one empties the other.
[[nodiscard]] std::optional<RecordError> refuse_names(const std::string& in,
                                                      const std::string& out) {
  std::error_code error;
  const bool is_recording = std::filesystem::equivalent(in, out, error);
  const bool is_events = std::filesystem::equivalent(record::operator_events_path(in), out, error);
  if (!is_recording && !is_events) return std::nullopt;
  return RecordError{out, 0, "is what is to be converted", "name another file after --mcap"};
}

[[nodiscard]] std::optional<RecordError> copy_rows(RecordingReader& recording, MotionFile& file,
                                                   EventMerge& events, ConversionReport& report) {
  RecordingRow row;
  std::int64_t first_ns = 0;
  for (std::uint64_t line = 2;; ++line) {
    const auto read = recording.next(row);
    if (!read) return read.error();
    if (!*read) break;
    if (!MotionFile::has_time(row.due_ns)) {
      return RecordError{recording.path(), line,
                         "column 'due_ns' holds " + std::to_string(row.due_ns) +
                             ", which is no time of a file in MCAP",
                         "the clock was before 0 or beyond 68 years: record again"};
    }
    if (report.rows++ == 0) first_ns = row.due_ns;
    if (auto error = events.write_up_to(row)) return error;
    if (!file.write(row)) return std::nullopt;  // close() tells
  }
  if (report.rows == 0) return RecordError{recording.path(), 0, "no cycle is in it", ""};
  report.length_s = 1e-9 * static_cast<double>(row.due_ns - first_ns);
  return events.write_rest(row);
}

}  // namespace

Expected<ConversionReport, RecordError> convert(const std::string& in, const std::string& out,
                                                const MachineModel& model) {
  if (auto error = refuse_names(in, out)) return tl::make_unexpected(std::move(*error));
  auto recording = RecordingReader::open(in, model);
  if (!recording) return tl::make_unexpected(std::move(recording.error()));
  auto file = MotionFile::create(out, model, contents_of(*recording),
                                 std::filesystem::path(in).filename().string());
  if (!file) return tl::make_unexpected(std::move(file.error()));
  ConversionReport report;
  EventMerge events(record::operator_events_path(in), **file, model.cycle_ns);
  auto wrong = copy_rows(*recording, **file, events, report);
  auto lost = (*file)->close();
  if (wrong) return tl::make_unexpected(std::move(*wrong));
  if (lost) return tl::make_unexpected(std::move(*lost));
  report.events = (*file)->events();
  report.bytes = (*file)->bytes();
  return report;
}

std::string to_text(const ConversionReport& report, const std::string& out) {
  std::string text;
  text::append(text, "%s: %llu rows of %.3f s, %llu events, %.1f MB", out.c_str(),
               text::Count{report.rows}, report.length_s, text::Count{report.events},
               1e-6 * static_cast<double>(report.bytes));
  if (report.length_s > 0) {
    text::append(text, ", %.0f MB an hour",
                 1e-6 * static_cast<double>(report.bytes) * 3600 / report.length_s);
  }
  return text + "\n";
}

}  // namespace meridian::ros
