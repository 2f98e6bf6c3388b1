// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded_limits.hpp"

#include "service/recording/record/file/event_fields.hpp"

namespace meridian::record {

bool is_limits_row(std::string_view row) {
  (void)next_field(row);
  return next_field(row) == kLimitsWord;
}

std::optional<RecordedLimits> read_limits(std::string_view row) {
  RecordedLimits limits;
  const bool is_right = read_field(row, limits.cycle) && next_field(row) == kLimitsWord &&
                        read_field(row, limits.joint) && limits.joint <= kMaxJoints &&
                        read_finite(row, limits.min) && read_finite(row, limits.max);
  return is_right && row.empty() ? std::optional(limits) : std::nullopt;
}

std::vector<LimitsFrom> find_all_limits(std::string_view events) {
  std::vector<LimitsFrom> all;
  each_row(events, [&all](std::string_view row) {
    const auto limits = read_limits(row);
    if (!limits) return;
    if (all.empty() || all.back().cycle != limits->cycle) all.push_back({limits->cycle, {}});
    if (limits->joint > 0) all.back().limits.put(limits->joint - 1, limits->min, limits->max);
  });
  return all;
}

std::optional<SoftLimits> find_recorded_limits(std::string_view events) {
  const std::uint64_t start = first_start(events);
  std::optional<SoftLimits> found;
  for (const LimitsFrom& from : find_all_limits(events)) {
    if (from.cycle <= start) found = from.limits;
  }
  return found;
}

}  // namespace meridian::record
