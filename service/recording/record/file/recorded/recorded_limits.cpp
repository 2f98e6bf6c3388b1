// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/recorded_limits.hpp"

#include "service/recording/record/file/recorded/event_fields.hpp"

namespace meridian::record {

bool is_limits_row(std::string_view row) {
  (void)next_field(row);
  const std::string_view word = next_field(row);
  return word == kLimitsWord || word == kKeepOutWord || word == kTipBoxWord;
}

std::optional<RecordedLimits> read_limits(std::string_view row) {
  RecordedLimits limits;
  if (!is_limits_row(row)) return std::nullopt;
  bool is_right = read_field(row, limits.cycle);
  const std::string_view word = next_field(row);
  const bool is_box = word == kKeepOutWord, is_tip = word == kTipBoxWord;
  if (is_tip) limits.box = kTipBoxNumber;
  if (is_box) {
    is_right = is_right && read_field(row, limits.box) && limits.box > 0 &&
               limits.box <= std::uint32_t{KeepOut::kMax};
  }
  is_right = is_right && read_field(row, limits.joint) &&
             limits.joint <= (is_tip ? 3 : kMaxJoints) && (limits.box == 0 || limits.joint > 0) &&
             read_finite(row, limits.min) && read_finite(row, limits.max);
  return is_right && row.empty() ? std::optional(limits) : std::nullopt;
}

std::vector<LimitsFrom> find_all_limits(std::string_view events) {
  std::vector<LimitsFrom> all;
  KeepOutBox box;  // of which rows come, the tip box too
  std::uint32_t number = 0;
  const auto finish_box = [&] {
    if (number == kTipBoxNumber) {
      LimitsOrder order;
      order.box = box;
      all.back().limits.put(order.tip_box());
    } else if (number > 0) {
      (void)all.back().limits.put(box);
    }
    box = {};
    number = 0;
  };
  each_row(events, [&](std::string_view row) {
    const auto limits = read_limits(row);
    if (!limits) return;
    const bool is_other = all.empty() || all.back().cycle != limits->cycle;
    if (is_other || limits->box != number) finish_box();
    if (is_other) all.push_back({limits->cycle, {}});
    number = limits->box;
    if (number == 0 && limits->joint > 0) {
      all.back().limits.put(limits->joint - 1, limits->min, limits->max);
    }
    if (number == 0) return;
    box.name.front() = static_cast<char>('0' + number);
    box.joints |= 1U << (limits->joint - 1);
    box.min[limits->joint - 1] = limits->min;
    box.max[limits->joint - 1] = limits->max;
  });
  finish_box();
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
