// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// What came from outside, made fit for a line of a log or of a terminal.
namespace meridian::text {

/// What printable() does with the ends of lines.
enum class Newlines { kEscaped, kKept };

/// `text` without anything that a terminal or a log takes for more than a character: control
/// characters (C0, DEL, C1), bytes that are no UTF-8, line and paragraph separators and marks that
/// turn the direction of writing become `\n`, `\t`, `\xHH` or `\uHHHH`. What is fit already stays
/// as it is, backslashes too, so that doing it twice changes nothing. At most `max` bytes, cut
/// between characters. Proof: tests/unit/text/printable_test.cpp.
[[nodiscard]] std::string printable(std::string_view text, std::size_t max = std::string::npos,
                                    Newlines newlines = Newlines::kEscaped);

/// Whether printable() would leave `text` as it is.
[[nodiscard]] bool is_printable(std::string_view text) noexcept;

/// How many bytes of `text`, at most `max`, end between two of its characters.
[[nodiscard]] std::size_t whole_characters(std::string_view text, std::size_t max) noexcept;

}  // namespace meridian::text
