// SPDX-License-Identifier: Apache-2.0
#include "service/record/recorded_frame.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "meridian/rt/state_table.hpp"

namespace meridian::record {
namespace {

[[nodiscard]] std::string_view next_field(std::string_view& row) {
  const std::size_t end = std::min(row.find(','), row.size());
  const std::string_view field = row.substr(0, end);
  row.remove_prefix(std::min(end + 1, row.size()));
  return field;
}

template <class Number>
[[nodiscard]] bool read_field(std::string_view& row, Number& value) {
  const std::string_view field = next_field(row);
  const char* const end = field.data() + field.size();
  const auto [rest, error] = std::from_chars(field.data(), end, value);
  return error == std::errc() && rest == end;
}

[[nodiscard]] bool read_finite(std::string_view& row, double& value) {
  return read_field(row, value) && std::isfinite(value);
}

}  // namespace

bool is_frame_row(std::string_view row) {
  (void)next_field(row);
  return next_field(row) == kFrameWord;
}

std::optional<RecordedFrame> read_frame(std::string_view row) {
  if (row.ends_with('\r')) row.remove_suffix(1);
  RecordedFrame frame;
  bool is_right = read_field(row, frame.cycle) && next_field(row) == kFrameWord &&
                  read_field(row, frame.number);
  for (double& value : frame.origin_mm) is_right = is_right && read_finite(row, value);
  for (double& value : frame.rotation) is_right = is_right && read_finite(row, value);
  return is_right && row.empty() ? std::optional(frame) : std::nullopt;
}

std::optional<RecordedFrame> find_recorded_frame(std::string_view events) {
  const std::string_view start = name_of(Verb::kStart);
  std::uint64_t start_cycle = ~std::uint64_t{0};
  std::optional<RecordedFrame> found;
  const auto each_row = [events](auto look) {
    for (std::string_view rest = events; !rest.empty();) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      look(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  };
  each_row([&](std::string_view row) {
    std::uint64_t cycle = 0;
    const bool is_start = read_field(row, cycle) && next_field(row) == start;
    if (is_start) start_cycle = std::min(start_cycle, cycle);
  });
  each_row([&](std::string_view row) {
    const auto frame = read_frame(row);
    if (frame && frame->cycle <= start_cycle) found = frame;
  });
  return found;
}

}  // namespace meridian::record
