// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/operator_events.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "meridian/cycle/state_table.hpp"
#include "service/recording/record/file/recorded/operator_events_writer.hpp"
#include "service/text/number.hpp"
#include "service/text/printed.hpp"

namespace meridian::simulate {
namespace {

[[nodiscard]] std::string_view cut(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  while (!part.empty() && (part.front() == ' ' || part.front() == '\t')) part.remove_prefix(1);
  while (!part.empty() && (part.back() == ' ' || part.back() == '\t' || part.back() == '\r')) {
    part.remove_suffix(1);
  }
  return part;
}

[[nodiscard]] std::optional<Verb> find_verb(std::string_view word) {
  for (int i = 0; i < kVerbCount; ++i) {
    if (word == name_of(static_cast<Verb>(i))) return static_cast<Verb>(i);
  }
  return std::nullopt;
}

[[nodiscard]] bool is_switch(Verb verb) {
  return verb == Verb::kSingleBlock || verb == Verb::kOptionalStop;
}

[[nodiscard]] bool is_override(Verb verb) {
  return verb == Verb::kFeedOverride || verb == Verb::kRapidOverride;
}

/// "'text' what".
[[nodiscard]] std::string about(std::string_view text, std::string_view what) {
  std::string out(1, '\'');
  return out.append(text).append("' ").append(what);
}

constexpr double kMaxPeriods = 1e9;

[[nodiscard]] bool is_of_loss(std::string_view word) {
  return word == record::kPeriodsBridgedWord || word == record::kPeriodsLostWord;
}

/// What counts periods.
[[nodiscard]] bool is_count(std::string_view word) {
  return is_of_loss(word) || word == record::kContactFoundWord;
}

struct EventRow {
  std::string_view word;
  OperatorEvent event;  ///< its verb: that of `word` where it is one
};

/// What is wrong with the row, empty if nothing is.
[[nodiscard]] std::string read_row(std::string_view text, double max_feed, EventRow& row) {
  const std::string_view cycle = cut(text, ',');
  row.word = cut(text, ',');
  const std::string_view argument = cut(text, ',');
  if (!text::read_number(cycle, row.event.cycle)) return about(cycle, "is no cycle number");
  const bool counts = is_count(row.word);
  const bool is_of_host = counts || row.word == record::kActionAnsweredWord;
  const auto verb = find_verb(row.word);
  if (!verb && !is_of_host) return about(row.word, "is no verb (hold, resume, feed_override, ...)");
  double& value = row.event.argument;
  if (!argument.empty() && (!text::read_number(argument, value) || !std::isfinite(value))) {
    return about(argument, "is no number");
  }
  if (!text.empty()) return "there is more than cycle, verb and argument";
  if (is_of_host) {
    const double max = counts ? kMaxPeriods : 1;
    const bool is_whole = !argument.empty() && value >= (counts ? 1 : 0) && value <= max &&
                          value == std::floor(value);
    return is_whole ? "" : about(row.word, "needs a whole number");
  }
  row.event.verb = *verb;
  if (is_switch(*verb) && (argument.empty() || (value != 0 && value != 1))) {
    return about(row.word, "needs 1 (on) or 0 (off)");
  }
  if (is_override(*verb) && argument.empty()) return about(row.word, "needs its factor");
  const double max = *verb == Verb::kFeedOverride ? max_feed : 1;
  if (is_override(*verb) && !(value >= 0 && value <= max)) {
    std::string fault = about(argument, "is no factor from 0 to ");
    text::append(fault, "%.4g", max);
    return fault;
  }
  return "";
}

/// Puts the row where it belongs; cycles count from `zero`.
void keep(const EventRow& row, std::int64_t zero, OperatorEvents& events) {
  const std::int64_t cycle = row.event.cycle - zero;
  if (cycle < 0) return;
  if (is_of_loss(row.word)) {
    events.losses.push_back(
        {cycle, static_cast<int>(row.event.argument), row.word == record::kPeriodsBridgedWord});
  } else if (row.word == record::kContactFoundWord) {
    events.verbs.push_back({cycle, Verb::kAbort, 0});  // it stops as an abort does
  } else if (row.word == record::kActionAnsweredWord) {
    events.answers.push_back({cycle, row.event.argument != 0});
  } else if (row.event.verb != Verb::kStart || cycle > 0) {
    // Said for a dry run alone, or to probe: a simulation moves no drive, and its contact is there.
    const double argument = may_be_dry(row.event.verb) ? 0 : row.event.argument;
    events.verbs.push_back({cycle, row.event.verb, argument});
  }
}

/// A row of the planner; false if it is none or holds anything else.
[[nodiscard]] bool read_mark(std::string_view row, FeedMark& mark) {
  (void)cut(row, ',');
  const std::string_view word = cut(row, ','), factor = cut(row, ',');
  mark.is_begin = word == record::kPlanBegunWord;
  if (mark.is_begin && row.empty()) return true;  // of before, which did not record the tool
  if (mark.is_begin) {
    const std::string_view length = cut(row, ',');
    return row.empty() && text::read_number(length, mark.tool_length_mm) &&
           mark.tool_length_mm >= 0;
  }
  if (word == record::kPlanLookedWord) {
    const bool is_begin = row.empty();
    const std::string_view from = cut(row, ',');
    return row.empty() && text::read_number(factor, mark.looked_at) && mark.looked_at > 0 &&
           (is_begin || (text::read_number(from, mark.sequence) && mark.sequence > 0));
  }
  const std::string_view block = cut(row, ','), span = cut(row, ',');
  return word == record::kFeedPlannedWord && row.empty() &&
         text::read_number(factor, mark.factor) && mark.factor >= 1 && std::isfinite(mark.factor) &&
         text::read_number(block, mark.sequence) && text::read_number(span, mark.span);
}

/// Of what came before the start, the overrides and switches in force then.
void keep_settings(const std::vector<EventRow>& rows, std::int64_t start,
                   std::vector<OperatorEvent>& verbs) {
  for (const Verb verb :
       {Verb::kFeedOverride, Verb::kRapidOverride, Verb::kSingleBlock, Verb::kOptionalStop}) {
    const EventRow* last = nullptr;
    for (const EventRow& row : rows) {
      if (row.event.cycle < start && row.word == name_of(verb)) last = &row;
    }
    if (last != nullptr) verbs.push_back({-1, verb, last->event.argument});
  }
}

}  // namespace

Expected<OperatorEvents, std::string> read_operator_events(std::string_view text,
                                                           const std::string& name,
                                                           double max_feed) {
  const std::string_view all = text;
  std::vector<EventRow> rows;
  OperatorEvents events;
  std::optional<std::int64_t> start;
  bool is_first_program = true;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view part = cut(text, '\n');
    if (part.empty() || part.front() == '#' || part.starts_with("cycle,verb,argument")) continue;
    if (record::is_frame_row(part)) {
      if (record::read_frame(part)) continue;
      return tl::make_unexpected(name + ":" + std::to_string(line) + ": holds no work frame");
    }
    if (record::is_tool_row(part)) {
      if (record::read_tool(part)) continue;
      return tl::make_unexpected(name + ":" + std::to_string(line) + ": holds no tool");
    }
    if (record::is_limits_row(part)) {
      if (record::read_limits(part)) continue;
      return tl::make_unexpected(name + ":" + std::to_string(line) + ": holds no soft limits");
    }
    if (FeedMark mark; read_mark(part, mark)) {
      if (mark.is_begin) is_first_program = !start;
      if (mark.is_begin && is_first_program) events.feed_marks.clear();
      if (is_first_program) events.feed_marks.push_back(mark);
      continue;
    }
    EventRow row;
    std::string fault = part == "incomplete" ? "the recorder lost events: they cannot be replayed"
                                             : read_row(part, max_feed, row);
    if (fault.empty() && !rows.empty() && row.event.cycle < rows.back().event.cycle) {
      fault = "cycles do not go up";
    }
    if (!fault.empty()) {
      return tl::make_unexpected(name + ":" + std::to_string(line) + ": " + fault);
    }
    if (row.word == name_of(Verb::kStart) && !start) start = row.event.cycle;
    rows.push_back(row);
  }
  events.frame = record::find_recorded_frame(all);
  events.tools = record::find_recorded_tools(all);
  events.limits = record::find_recorded_limits(all);
  if (start) keep_settings(rows, *start, events.verbs);
  for (const EventRow& row : rows) keep(row, start.value_or(0), events);
  return events;
}

}  // namespace meridian::simulate
