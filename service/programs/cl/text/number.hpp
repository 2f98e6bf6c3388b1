// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace meridian::cl {

/// Reads `text` whole as a decimal number: 1, -1.5, .5, 25., +1E3, 1.5D-3. Correctly rounded.
///
/// False where anything is left over, where there is no digit, or where the value does not fit a
/// double; words such as NAN and INF are not numbers. Proof: tests/unit/cl/number_test.cpp.
[[nodiscard]] bool parse_number(std::string_view text, double& value) noexcept;

/// The same; `decimals`: digits after the point, kMaxDecimals for a number with an exponent.
[[nodiscard]] bool parse_number(std::string_view text, double& value,
                                std::uint8_t& decimals) noexcept;
inline constexpr std::uint8_t kMaxDecimals = 15;

/// The start of every number that parse_number takes.
[[nodiscard]] constexpr bool starts_number(char c) noexcept {
  return (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '+';
}

}  // namespace meridian::cl
