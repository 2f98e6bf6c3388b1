// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

namespace meridian::text {

/// Reads the number that `text` is; false where it is none, or where anything stands behind it.
/// Proof: tests/unit/text/number_test.cpp.
template <class Number>
[[nodiscard]] bool read_number(std::string_view text, Number& value) noexcept {
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end;
}

/// As read_number(); false also of `inf` and `nan`.
[[nodiscard]] inline bool read_finite(std::string_view text, double& value) noexcept {
  return read_number(text, value) && std::isfinite(value);
}

}  // namespace meridian::text
