// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/cycle/state.hpp"
#include "meridian/expected.hpp"
#include "meridian/planner/feed_mark.hpp"
#include "service/recording/record/file/recorded/recorded_frame.hpp"
#include "service/recording/record/file/recorded/recorded_limits.hpp"
#include "service/recording/record/file/recorded/recorded_tools.hpp"

namespace meridian::simulate {

/// What an operator asked for, and when. `cycle` counts from the cycle that took the start.
struct OperatorEvent {
  std::int64_t cycle = 0;  ///< below 0: ahead of the start
  Verb verb = Verb::kHold;
  double argument = 0;
};

/// Periods that a live run lost in front of a cycle.
struct LostPeriods {
  std::int64_t cycle = 0;  ///< the first that was executed again, counted from the start's
  int count = 0;
  bool is_bridged = true;  ///< by the drives; plan time went on meanwhile
};

/// When a live run took the answer to the action that it waited for.
struct ActionAnswer {
  std::int64_t cycle = 0;  ///< counted from that of the start
  bool is_done = true;
};

/// What a run is replayed from, beside its program; each list in the order of cycles.
struct OperatorEvents {
  std::vector<OperatorEvent> verbs;
  std::vector<LostPeriods> losses;
  std::vector<ActionAnswer> answers;
  /// What the live planner reported of feed overrides above 100 % and of its look-ahead at the
  /// begin; empty: it is planned as a service would that waits for no block.
  std::vector<FeedMark> feed_marks;
  /// Where the workpiece lay; nothing: that is not known.
  std::optional<record::RecordedFrame> frame;
  /// With which tools; nothing: that is not recorded.
  std::optional<ToolTable> tools;
  /// Under which soft limits; nothing: that is not recorded.
  std::optional<SoftLimits> limits;
};

/// Reads operator events: a row `cycle,verb[,argument]` each, in the order of cycles; the header
/// `cycle,verb,argument,block,span`, empty lines and lines that begin with # are skipped. Verbs are
/// those of name_of(Verb); an override's argument is its factor, that of the feed up to
/// `max_feed`. A row `start` says which cycle the others count from (that of a live run); without
/// one they count from the start as they are. Of what was before the start the overrides in force
/// then are replayed, nothing else. Four words stand beside the verbs, with the host's part in a
/// live run: `periods_bridged` and `periods_lost`, how many before this cycle, `action_answered`, 1
/// done, 0 refused, and `contact_found`, which stops a probing move; three with the planner's:
/// `plan_begun,1[,length of the tool]`, `plan_looked,blocks[,block]` and
/// `feed_planned,factor,block,span`. Rows `frame` (RecordedFrame), `tool` (RecordedTool) and
/// `limits` (RecordedLimits) stand anywhere. A row `incomplete`, by which a recorder says that it
/// lost events, is refused. The error is a message with name and line. Proof:
/// tests/unit/simulate/operator_events_test.cpp.
[[nodiscard]] Expected<OperatorEvents, std::string> read_operator_events(std::string_view text,
                                                                         const std::string& name,
                                                                         double max_feed = 1.0);

}  // namespace meridian::simulate
