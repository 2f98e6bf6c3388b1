// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/expected.hpp"
#include "service/recording/record/file/csv_file.hpp"
#include "service/recording/record/file/record_error.hpp"
#include "service/recording/record/file/recorded/recorded_frame.hpp"
#include "service/recording/record/file/recorded/recorded_limits.hpp"
#include "service/recording/record/file/recorded/recorded_tools.hpp"

namespace meridian::record {

/// The file of operator events that belongs to a recording: run.csv has run.events.csv.
[[nodiscard]] std::string operator_events_path(const std::string& recording);

/// What stands where rows of operators have their verb: the argument says how many periods were
/// lost before the row's cycle (bridged by the drives, or more than they bridge), or whether the
/// action that was waited for is done (1) or refused (0).
inline constexpr std::string_view kPeriodsBridgedWord = "periods_bridged";
inline constexpr std::string_view kPeriodsLostWord = "periods_lost";
inline constexpr std::string_view kActionAnsweredWord = "action_answered";
/// A probing move found its contact, so many periods behind the report before: it aborted itself.
inline constexpr std::string_view kContactFoundWord = "contact_found";
/// Of the planner: it begins a program (at a factor of 1, with a tool so long in the spindle as the
/// next column says); it plans for a feed override above 100 %, the argument, from the block and
/// span of it on that two more columns hold (FeedMark).
inline constexpr std::string_view kPlanBegunWord = "plan_begun";
inline constexpr std::string_view kFeedPlannedWord = "feed_planned";
/// And over how many blocks it chose branch and winding, the argument: the first, or those from a
/// block on that one more column holds.
inline constexpr std::string_view kPlanLookedWord = "plan_looked";

/// Whether the motion follows from it, beside the program: an accepted verb, lost periods, an
/// answered action, a contact that was sought, what the planner planned with.
[[nodiscard]] bool is_replayed(const Event& event) noexcept;

/// Writes what operators asked for and the cycle took, and what else the world did to it, one row
/// `cycle,verb,argument` each, for `meridian simulate --events`. Every row reaches the system at
/// once: there are few.
/// Proof: tests/unit/record/operator_events_writer_test.cpp.
class OperatorEventsWriter {
 public:
  /// Its name was made up, not given: a link there is not followed.
  [[nodiscard]] static Expected<OperatorEventsWriter, RecordError> create(const std::string& path);

  /// Adds the event if it is_replayed(); others are passed over. False once a write failed.
  bool write(const Event& event) noexcept;
  /// Adds where the workpiece lies from a cycle on. False once a write failed.
  bool write(const RecordedFrame& frame) noexcept;
  /// Adds a tool of the table that is in force from a cycle on. False once a write failed.
  bool write(const RecordedTool& tool) noexcept;
  /// Adds soft limits of a joint that are in force from a cycle on. False once a write failed.
  bool write(const RecordedLimits& limits) noexcept;
  /// Says in the file that events are missing, once: `meridian simulate --events` refuses it then.
  void mark_incomplete() noexcept;
  /// Flushes and closes; false where anything was lost.
  bool close() noexcept { return file_.close(); }
  [[nodiscard]] int error_number() const noexcept { return file_.error_number(); }

 private:
  explicit OperatorEventsWriter(CsvFile file) : file_(std::move(file)) {}
  CsvFile file_;
  bool is_marked_ = false;
};

}  // namespace meridian::record
