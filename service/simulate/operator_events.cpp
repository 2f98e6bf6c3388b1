// SPDX-License-Identifier: Apache-2.0
#include "service/simulate/operator_events.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "meridian/rt/state_table.hpp"

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

template <class Number>
[[nodiscard]] bool parse(std::string_view text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end;
}

[[nodiscard]] std::optional<Verb> find_verb(std::string_view word) {
  for (int i = 0; i < kVerbCount; ++i) {
    if (word == name_of(static_cast<Verb>(i))) return static_cast<Verb>(i);
  }
  return std::nullopt;
}

[[nodiscard]] bool needs_argument(Verb verb) {
  return verb == Verb::kFeedOverride || verb == Verb::kRapidOverride;
}

/// "'text' what".
[[nodiscard]] std::string about(std::string_view text, std::string_view what) {
  std::string out(1, '\'');
  return out.append(text).append("' ").append(what);
}

/// What is wrong with the row, empty if nothing is.
[[nodiscard]] std::string read_row(std::string_view row, OperatorEvent& event) {
  const std::string_view cycle = cut(row, ','), word = cut(row, ','), argument = cut(row, ',');
  if (!parse(cycle, event.cycle)) return about(cycle, "is no cycle number");
  const auto verb = find_verb(word);
  if (!verb) return about(word, "is no verb (hold, resume, feed_override, ...)");
  event.verb = *verb;
  event.argument = 0;
  if (!argument.empty() && (!parse(argument, event.argument) || !std::isfinite(event.argument))) {
    return about(argument, "is no number");
  }
  if (needs_argument(*verb) && argument.empty()) return about(word, "needs its factor");
  if (needs_argument(*verb) && !(event.argument >= 0 && event.argument <= 1)) {
    return about(argument, "is no factor from 0 to 1");
  }
  return row.empty() ? "" : "there is more than cycle, verb and argument";
}

}  // namespace

Expected<std::vector<OperatorEvent>, std::string> read_operator_events(std::string_view text,
                                                                       const std::string& name) {
  std::vector<OperatorEvent> events;
  std::optional<std::int64_t> start;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view row = cut(text, '\n');
    if (row.empty() || row.front() == '#' || row == "cycle,verb,argument") continue;
    OperatorEvent event;
    std::string fault = row == "incomplete" ? "the recorder lost events: they cannot be replayed"
                                            : read_row(row, event);
    if (fault.empty() && !events.empty() && event.cycle < events.back().cycle) {
      fault = "cycles do not go up";
    }
    if (!fault.empty()) {
      return tl::make_unexpected(name + ":" + std::to_string(line) + ": " + fault);
    }
    if (event.verb == Verb::kStart && !start) start = event.cycle;
    events.push_back(event);
  }
  const std::int64_t zero = start.value_or(0);
  std::erase_if(events, [&](const OperatorEvent& event) {
    return event.cycle < zero || event.verb == Verb::kStart;
  });
  for (OperatorEvent& event : events) event.cycle -= zero;
  return events;
}

}  // namespace meridian::simulate
