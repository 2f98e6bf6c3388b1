// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian::cl {

/// Signs of CL and NC files: ASCII, whatever the locale.
[[nodiscard]] constexpr char capital(char c) noexcept {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

[[nodiscard]] constexpr bool is_letter(char c) noexcept {
  return capital(c) >= 'A' && capital(c) <= 'Z';
}

[[nodiscard]] constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

[[nodiscard]] constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }

}  // namespace meridian::cl
