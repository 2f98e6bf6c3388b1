// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian::cl {

/// Of the letters that words of CL files have: ASCII, whatever the locale.
[[nodiscard]] constexpr char capital(char c) noexcept {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

[[nodiscard]] constexpr bool is_letter(char c) noexcept {
  return capital(c) >= 'A' && capital(c) <= 'Z';
}

}  // namespace meridian::cl
