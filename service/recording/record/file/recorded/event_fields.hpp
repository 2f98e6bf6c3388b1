// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "meridian/cycle/state_table.hpp"
#include "service/text/number.hpp"

/// Fields and rows of the events beside a recording, for who reads rows of the set-up.
namespace meridian::record {

[[nodiscard]] inline std::string_view next_field(std::string_view& row) {
  const std::size_t end = std::min(row.find(','), row.size());
  const std::string_view field = row.substr(0, end);
  row.remove_prefix(std::min(end + 1, row.size()));
  return field;
}

template <class Number>
[[nodiscard]] bool read_field(std::string_view& row, Number& value) {
  return text::read_number(next_field(row), value);
}

[[nodiscard]] inline bool read_finite(std::string_view& row, double& value) {
  return read_field(row, value) && std::isfinite(value);
}

/// Calls `look` with every row, line ends taken off.
template <class Look>
void each_row(std::string_view events, Look look) {
  while (!events.empty()) {
    const std::size_t end = std::min(events.find('\n'), events.size());
    std::string_view row = events.substr(0, end);
    if (row.ends_with('\r')) row.remove_suffix(1);
    look(row);
    events.remove_prefix(std::min(end + 1, events.size()));
  }
}

/// The cycle that took the first start; the last that there can be where none did.
[[nodiscard]] inline std::uint64_t first_start(std::string_view events) {
  std::uint64_t first = ~std::uint64_t{0};
  each_row(events, [&first](std::string_view row) {
    std::uint64_t cycle = 0;
    const bool is_start = read_field(row, cycle) && next_field(row) == name_of(Verb::kStart);
    if (is_start) first = std::min(first, cycle);
  });
  return first;
}

}  // namespace meridian::record
