// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/recorded_frame.hpp"

#include "service/recording/record/file/recorded/event_fields.hpp"

namespace meridian::record {

bool is_frame_row(std::string_view row) {
  (void)next_field(row);
  return next_field(row) == kFrameWord;
}

std::optional<RecordedFrame> read_frame(std::string_view row) {
  RecordedFrame frame;
  bool is_right = read_field(row, frame.cycle) && next_field(row) == kFrameWord &&
                  read_field(row, frame.number);
  for (double& value : frame.origin_mm) is_right = is_right && read_finite(row, value);
  for (double& value : frame.rotation) is_right = is_right && read_finite(row, value);
  return is_right && row.empty() ? std::optional(frame) : std::nullopt;
}

std::optional<RecordedFrame> find_recorded_frame(std::string_view events) {
  const std::uint64_t start = first_start(events);
  std::optional<RecordedFrame> found;
  each_row(events, [&](std::string_view row) {
    const auto frame = read_frame(row);
    if (frame && frame->cycle <= start) found = frame;
  });
  return found;
}

}  // namespace meridian::record
