// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <array>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "service/machine/file/config_error.hpp"
#include "service/machine/file/range.hpp"

namespace meridian::config {

/// Reads a TOML file. Throws ConfigError where there is none or it is not TOML.
[[nodiscard]] toml::table parse_file(const std::filesystem::path& path);

/// The same for text; `name` is what messages call it.
[[nodiscard]] toml::table parse_text(std::string_view text, const std::string& name);

/// One table of a TOML file that is read key by key. It remembers what was asked for, so that
/// finish() can refuse every other key; each refusal names file, line, key, value, what is allowed
/// and the remedy. The table must outlive it. Everything throws ConfigError.
class Section {
 public:
  Section(std::string file, const toml::table& table, std::string name = "");

  /// Numbers: the key must be there, finite and inside `range`.
  [[nodiscard]] double number(std::string_view key, Range range, std::string_view remedy = "");
  [[nodiscard]] double number_or(std::string_view key, double otherwise, Range range);
  [[nodiscard]] int integer(std::string_view key, int low, int high, std::string_view remedy = "");
  [[nodiscard]] int integer_or(std::string_view key, int otherwise, int low, int high);
  [[nodiscard]] std::array<double, 2> pair(std::string_view key, Range range,
                                           std::string_view remedy = "");
  [[nodiscard]] std::array<double, 3> triple(std::string_view key, Range range,
                                             std::string_view remedy = "");
  [[nodiscard]] std::array<double, 3> triple_or(std::string_view key,
                                                std::array<double, 3> otherwise, Range range);

  /// `min` to `max` numbers in brackets; a refusal names the number that is wrong.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t min, std::size_t max,
                                            Range range, std::string_view remedy = "");

  [[nodiscard]] bool truth_or(std::string_view key, bool otherwise);

  /// Text: at least one character unless `may_be_empty`.
  [[nodiscard]] std::string text(std::string_view key, std::string_view remedy = "");
  [[nodiscard]] std::string text_or(std::string_view key, std::string_view otherwise);
  /// As many texts in brackets as `count` says.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key, std::size_t count,
                                               std::string_view remedy = "");

  /// Returns the place in `choices` of the word that the file gives.
  [[nodiscard]] int choice(std::string_view key, std::initializer_list<std::string_view> choices);
  [[nodiscard]] int choice_or(std::string_view key, int otherwise,
                              std::initializer_list<std::string_view> choices);

  /// A table inside this one; section_or() gives an empty one where the file has none.
  [[nodiscard]] Section section(std::string_view key);
  [[nodiscard]] Section section_or(std::string_view key);
  /// An array of tables, [[key]]; it may be missing.
  [[nodiscard]] std::vector<Section> sections_or(std::string_view key);

  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }

  /// Refuses every key that was never asked for, with the name that it may have been meant to be.
  void finish() const;

  /// Refuses `key` (or its absence) for a reason that only the caller knows.
  [[noreturn]] void refuse(std::string_view key, std::string allowed, std::string remedy) const;

 private:
  [[nodiscard]] const toml::node* find(std::string_view key);
  [[nodiscard]] const toml::node& need(std::string_view key, const std::string& allowed,
                                       std::string_view remedy);
  [[nodiscard]] double finite_number(const toml::node& node, std::string_view key, Range range,
                                     std::string_view remedy) const;
  [[nodiscard]] std::string full_name(std::string_view key) const;
  [[nodiscard]] int line() const;

  std::string file_;
  const toml::table* table_;
  std::string name_;
  std::vector<std::string> known_;
};

}  // namespace meridian::config
