// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "meridian/expected.hpp"
#include "service/text/number.hpp"

/// Small files of `key = value` lines that show whether they are whole: the first line says what
/// they are, the last has a CRC-32C of all before it.
/// Proof: tests/unit/telemetry/journal_test.cpp, tests/unit/telemetry/set_up_text_test.cpp.
namespace meridian::telemetry {

/// The first `max` bytes of a file that is there and regular; nothing where none is there. No link
/// is followed, no pipe waited for. The error says what is wrong with it.
[[nodiscard]] Expected<std::optional<std::string>, std::string> read_small_file(
    const std::filesystem::path& path, std::size_t max);

[[nodiscard]] std::uint32_t crc_of(std::string_view text) noexcept;

/// `text` with the line of its checksum behind it.
[[nodiscard]] std::string seal(const std::string& text);

/// What is wrong with a sealed text as a whole, of which `head` is to be the first line and
/// `what`, as in "meridian WHAT ", its begin in every version; nothing: head and checksum fit.
[[nodiscard]] std::optional<std::string> find_damage(std::string_view text, std::string_view head,
                                                     std::string_view what);

/// Takes lines of `key = value` from a text, one after the other.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  [[nodiscard]] std::string_view next() {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    const std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    return line;
  }
  /// The value of the next line if that has `key`; else empty, and has_failed().
  [[nodiscard]] std::string_view value(std::string_view key) {
    const std::string_view line = next();
    const bool is_key = line.starts_with(key) && line.substr(key.size()).starts_with(" = ");
    has_failed_ = has_failed_ || !is_key;
    return is_key ? line.substr(key.size() + 3) : std::string_view();
  }
  template <class Number>
  void read(std::string_view key, Number& number) {
    const std::string_view text = value(key);
    has_failed_ = !text::read_number(text, number) || has_failed_;
  }
  /// Finds the value among `names`.
  template <class Names>
  [[nodiscard]] int find(std::string_view key, int count, Names name) {
    const std::string_view text = value(key);
    for (int i = 0; i < count; ++i) {
      if (text == name(i)) return i;
    }
    has_failed_ = true;
    return 0;
  }
  /// All that is after the line that were taken.
  [[nodiscard]] std::string_view rest() const noexcept { return text_; }
  [[nodiscard]] bool has_failed() const noexcept { return has_failed_; }

 private:
  std::string_view text_;
  bool has_failed_ = false;
};

}  // namespace meridian::telemetry
