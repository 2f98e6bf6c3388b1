// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/heidenhain/heidenhain_parameters.hpp"

#include <algorithm>
#include <string>

#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

constexpr std::size_t kDigitsOfFree = 2;  // Q0 to Q99

constexpr bool is_figure(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

}  // namespace

std::size_t length_of_parameter(std::string_view text) noexcept {
  if (!text.starts_with('Q')) return 0;
  const std::size_t first = text.size() > 1 && (text[1] == 'L' || text[1] == 'R') ? 2 : 1;
  std::size_t size = first;
  while (size < text.size() && is_figure(text[size])) ++size;
  return size > first ? size : 0;
}

bool is_free_parameter(std::string_view name) noexcept {
  return !name.empty() && length_of_parameter(name) == name.size() &&
         (!is_figure(name[1]) || name.size() - 1 <= kDigitsOfFree);
}

std::optional<double> number_of_parameter(std::string_view text, const Variables& variables) {
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  if (length_of_parameter(text) != text.size()) return std::nullopt;
  const auto number = variables.find(text);
  if (!number) return std::nullopt;
  return is_negative ? -*number : *number;
}

std::optional<double> read_number(std::string_view text, const Variables& variables) {
  if (const auto given = number_of_parameter(text, variables)) return given;
  std::string plain(text);
  std::replace(plain.begin(), plain.end(), ',', '.');
  double number = 0;
  return cl::parse_number(plain, number) ? std::optional(number) : std::nullopt;
}

cl::Outcome assign_parameter(std::string_view text, Variables& variables) {
  const std::string_view whole = trimmed(text);
  const std::string_view name = whole.substr(0, length_of_parameter(whole));
  std::string_view value = trimmed(whole.substr(name.size()));
  const bool is_assignment = !name.empty() && is_free_parameter(name) && value.starts_with('=');
  if (is_assignment) value = trimmed(value.substr(1));
  const auto number = read_number(value, variables);
  if (!is_assignment || !number) {
    return cl::refuse("a Q parameter: " + cl::quoted(whole.substr(0, 16)), kMovesByCam, "Q");
  }
  return variables.set(name, *number);
}

}  // namespace meridian::nc
