// SPDX-License-Identifier: Apache-2.0
#include "service/text/printable.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace meridian::text {
namespace {

/// A character of UTF-8 as it stands at the begin of a text.
struct Character {
  char32_t code = 0;
  std::size_t size = 0;  ///< bytes; 0: none stands there
};

[[nodiscard]] bool is_continued(char byte) noexcept {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

[[nodiscard]] Character first_of(std::string_view text) noexcept {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return {lead, 1};
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 0;
  if (size == 0 || lead > 0xF4 || text.size() < size) return {};
  char32_t code = lead & (0xFFU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if (!is_continued(text[i])) return {};
    code = (code << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  constexpr char32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kSmallest[size] || code > 0x10FFFF || is_surrogate) return {};
  return {code, size};
}

/// Whether a terminal shows `code` as a character and does nothing else.
[[nodiscard]] bool is_shown(char32_t code) noexcept {
  if (code < 0x20 || (code >= 0x7F && code < 0xA0)) return false;
  const bool is_direction = code == 0x061C || code == 0x200E || code == 0x200F ||
                            (code >= 0x202A && code <= 0x202E) ||
                            (code >= 0x2066 && code <= 0x2069);
  const bool is_separator = code == 0x2028 || code == 0x2029;
  return !is_direction && !is_separator && code != 0xFEFF;
}

[[nodiscard]] std::string escaped(const Character& what, char byte) {
  char text[16];
  if (what.size > 1) {
    std::snprintf(text, sizeof text, "\\u%04X", static_cast<unsigned>(what.code));
  } else if (byte == '\n' || byte == '\t' || byte == '\r') {
    return byte == '\n' ? "\\n" : byte == '\t' ? "\\t" : "\\r";
  } else {
    std::snprintf(text, sizeof text, "\\x%02X", static_cast<unsigned char>(byte));
  }
  return text;
}

[[nodiscard]] bool is_plain(std::string_view text) noexcept {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7F; });
}

}  // namespace

std::string printable(std::string_view text, std::size_t max, Newlines newlines) {
  if (is_plain(text)) return std::string(text.substr(0, max));
  std::string out;
  while (!text.empty()) {
    const Character what = first_of(text);
    const std::size_t size = std::max<std::size_t>(what.size, 1);
    const bool is_kept = what.size > 0 && (is_shown(what.code) ||
                                           (what.code == '\n' && newlines == Newlines::kKept));
    const std::string shown =
        is_kept ? std::string(text.substr(0, size)) : escaped(what, text.front());
    if (shown.size() > max - std::min(max, out.size())) break;
    out += shown;
    text.remove_prefix(size);
  }
  return out;
}

bool is_printable(std::string_view text) noexcept {
  while (!text.empty()) {
    const Character what = first_of(text);
    if (what.size == 0 || !is_shown(what.code)) return false;
    text.remove_prefix(what.size);
  }
  return true;
}

std::size_t whole_characters(std::string_view text, std::size_t max) noexcept {
  if (text.size() <= max) return text.size();
  std::size_t end = max;
  // No character has more than three bytes after its first.
  for (int n = 0; n < 3 && end > 0 && is_continued(text[end]); ++n) --end;
  return is_continued(text[end]) ? max : end;
}

}  // namespace meridian::text
