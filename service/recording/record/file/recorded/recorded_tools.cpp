// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/recorded_tools.hpp"

#include <utility>
#include <vector>

#include "service/recording/record/file/recorded/event_fields.hpp"
#include "service/recording/record/file/recorded/operator_events_writer.hpp"

namespace meridian::record {

bool is_tool_row(std::string_view row) {
  (void)next_field(row);
  return next_field(row) == kToolWord;
}

std::optional<RecordedTool> read_tool(std::string_view row) {
  RecordedTool tool;
  const bool is_right = read_field(row, tool.cycle) && next_field(row) == kToolWord &&
                        read_field(row, tool.number) && read_finite(row, tool.length_mm) &&
                        read_finite(row, tool.radius_mm);
  return is_right && row.empty() ? std::optional(tool) : std::nullopt;
}

std::optional<ToolTable> find_recorded_tools(std::string_view events) {
  const std::uint64_t start = first_start(events);
  std::optional<std::uint64_t> cycle;
  std::vector<Tool> tools;
  each_row(events, [&](std::string_view row) {
    const auto tool = read_tool(row);
    if (!tool || tool->cycle > start) return;
    if (cycle != tool->cycle) tools.clear();
    cycle = tool->cycle;
    if (tool->number != 0) tools.push_back({tool->number, tool->length_mm, tool->radius_mm});
  });
  return cycle ? std::optional(ToolTable(std::move(tools))) : std::nullopt;
}

std::optional<double> find_recorded_tool_length(std::string_view events) {
  const std::uint64_t start = first_start(events);
  std::optional<double> found;
  each_row(events, [&](std::string_view row) {
    std::uint64_t cycle = 0;
    double factor = 0, length_mm = 0;
    const bool is_begin = read_field(row, cycle) && next_field(row) == kPlanBegunWord &&
                          read_finite(row, factor) && read_finite(row, length_mm) && row.empty();
    if (is_begin && cycle <= start && length_mm > 0) found = length_mm;
  });
  return found;
}

}  // namespace meridian::record
