// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/words/variables.hpp"

#include <algorithm>

#include "service/programs/cl/text/letters.hpp"
#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr bool is_decimal(char c) { return c >= '0' && c <= '9'; }

std::string_view stripped(std::string_view text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
  return text;
}

bool is_name(std::string_view text) {
  const auto is_sign = [](char c) { return cl::is_letter(c) || is_decimal(c) || c == '_'; };
  return text.size() > 1 && text.size() < 32 && !is_decimal(text.front()) &&
         std::all_of(text.begin(), text.end(), is_sign);
}

}  // namespace

bool is_r_parameter(std::string_view name) noexcept {
  return name.size() > 1 && name.front() == 'R' &&
         std::all_of(name.begin() + 1, name.end(), is_decimal);
}

cl::Outcome Variables::declare(std::string_view text) {
  text = stripped(text);
  const std::size_t size = std::min(text.find(' '), text.size());
  const std::string_view type = text.substr(0, size);
  if (type != "REAL" && type != "INT") {
    return refuse("DEF " + std::string(type.substr(0, 16)) + ": only numbers (REAL, INT) are read",
                  kNumbersByCam, "DEF");
  }
  for (text.remove_prefix(size); !text.empty();) {
    const std::size_t stop = std::min(text.find(','), text.size());
    const std::string_view one = text.substr(0, stop);
    text.remove_prefix(std::min(stop + 1, text.size()));
    const std::size_t equals = std::min(one.find('='), one.size());
    const std::string_view name = stripped(one.substr(0, equals));
    if (!is_name(name) || numbers_.size() >= kMax) {
      return refuse("DEF of " + cl::quoted(name) + " is not understood", kNumbersByCam, "DEF");
    }
    numbers_.insert_or_assign(std::string(name), std::nullopt);
    if (equals == one.size()) continue;
    double number = 0;
    if (!cl::parse_number(stripped(one.substr(equals + 1)), number)) {
      return refuse("DEF gives " + std::string(name) + " no plain number", kNumbersByCam, "DEF");
    }
    numbers_.find(name)->second = number;
  }
  return {};
}

cl::Outcome Variables::set(std::string_view name, double number) {
  const auto at = numbers_.find(name);
  if (at != numbers_.end()) {
    at->second = number;
    return {};
  }
  if (!(is_r_parameter(name) || name.starts_with('Q')) || numbers_.size() >= kMax) {
    return refuse(
        "a value for " + std::string(name.substr(0, 32)) + ", which the control alone knows",
        kNumbersByCam, "value for " + std::string(name.substr(0, 32)));
  }
  numbers_.emplace(std::string(name), number);
  return {};
}

std::optional<double> Variables::find(std::string_view name) const {
  const auto at = numbers_.find(name);
  return at == numbers_.end() ? std::nullopt : at->second;
}

}  // namespace meridian::nc
