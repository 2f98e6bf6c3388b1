// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <utility>

#include "service/machine/file/toml_guard.hpp"

namespace meridian::config {
namespace {

const toml::table kNothing;

constexpr std::size_t kSimilar = 4;  // names that differ in fewer letters may be meant

std::string on_one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

std::string written(const toml::node& node) {
  std::ostringstream out;
  if (const auto* table = node.as_table()) {
    out << "a table with " << table->size() << " keys";
  } else if (const auto* array = node.as_array()) {
    out << toml::toml_formatter(*array);
  } else {
    node.visit([&out](const auto& value) {
      if constexpr (toml::is_value<decltype(value)>) out << toml::toml_formatter(value);
    });
  }
  return on_one_line(out.str());
}

std::string plain(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string words(Range range) {
  constexpr double kMax = std::numeric_limits<double>::max();
  if (range.low == -kMax && range.high == kMax) return "a finite number";
  if (range.high == kMax) return "at least " + plain(range.low);
  if (range.low == -kMax) return "at most " + plain(range.high);
  return plain(range.low) + " to " + plain(range.high);
}

std::string words(std::initializer_list<std::string_view> choices) {
  std::string text;
  for (const std::string_view choice : choices) {
    text += (text.empty() ? "\"" : ", \"") + std::string(choice) + "\"";
  }
  return text;
}

/// Levenshtein distance: how many letters differ.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t corner = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, corner + (a[i - 1] == b[j - 1] ? 0 : 1)});
      corner = above;
    }
  }
  return row[b.size()];
}

/// velocity_mm_per_min for velocity_mm_per_s: one quantity by its name, another unit behind it.
bool is_in_other_unit(std::string_view key, std::string_view other) {
  const std::size_t unit = std::min(key.find("_mm"), key.find("_deg"));
  if (unit == std::string_view::npos || other == key) return false;
  constexpr std::array<std::string_view, 6> kUnits = {"_mm", "_deg", "_rad", "_m", "_in", "_rpm"};
  const bool is_unit = std::any_of(kUnits.begin(), kUnits.end(), [&](std::string_view one) {
    return other.size() > unit && other.substr(unit).starts_with(one);
  });
  return other.starts_with(key.substr(0, unit)) && is_unit;
}

}  // namespace

toml::table parse_file(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    throw ConfigError({.file = path.string(),
                       .value = "there is no such file",
                       .allowed = "a TOML file that can be read",
                       .remedy = "check the path; deploy/machines has one file per machine"});
  }
  std::ifstream input(path, std::ios::binary);
  std::string text(kMaxTomlBytes + 1, '\0');
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(input.gcount()));
  return parse_text(text, path.string());
}

toml::table parse_text(std::string_view text, const std::string& name) {
  if (const auto bomb = find_toml_bomb(text)) {
    throw ConfigError({.file = name,
                       .line = bomb->line,
                       .value = bomb->words,
                       .allowed = "names and brackets up to " + std::to_string(kMaxTomlDepth) +
                                  " deep, " + std::to_string(kMaxTomlBytes) + " bytes",
                       .remedy = "name a file of this service"});
  }
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw ConfigError(
        {.file = name,
         .line = static_cast<int>(error.source().begin.line),
         .value = "this is not TOML: " + on_one_line(std::string(error.description())),
         .allowed = "TOML 1.0",
         .remedy = "mend the line named; a value needs `key = value`"});
  }
}

Section::Section(std::string file, const toml::table& table, std::string name)
    : file_(std::move(file)), table_(&table), name_(std::move(name)) {}

int Section::line() const { return static_cast<int>(table_->source().begin.line); }

std::string Section::full_name(std::string_view key) const {
  return name_.empty() ? std::string(key) : name_ + "." + std::string(key);
}

const toml::node* Section::find(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

void Section::refuse(std::string_view key, std::string allowed, std::string remedy) const {
  const toml::node* node = table_->get(key);
  throw ConfigError({.file = file_,
                     .line = node != nullptr ? static_cast<int>(node->source().begin.line) : line(),
                     .key = full_name(key),
                     .value = node != nullptr ? written(*node) : "",
                     .allowed = std::move(allowed),
                     .remedy = std::move(remedy)});
}

const toml::node& Section::need(std::string_view key, const std::string& allowed,
                                std::string_view remedy) {
  const toml::node* node = find(key);
  if (node != nullptr) return *node;
  std::string advice(remedy);
  std::string_view in_other_unit;
  for (const auto& [other, ignored] : *table_) {
    if (key.size() > 5 && distance(key, other.str()) == 1) {  // l3_mm and l4_mm are both right
      advice = "did you mean it by " + std::string(other.str()) + ", line " +
               std::to_string(other.source().begin.line) + "?";
    }
    if (is_in_other_unit(key, other.str())) in_other_unit = other.str();
  }
  if (advice.empty()) advice = name_.empty() ? "add it to the file" : "add it to [" + name_ + "]";
  if (!in_other_unit.empty()) {
    advice += "; is " + std::string(in_other_unit) + " the same in another unit? Convert it";
  }
  refuse(key, allowed, advice);
}

double Section::finite_number(const toml::node& node, std::string_view key, Range range,
                              std::string_view remedy) const {
  const auto value = node.value<double>();
  const bool is_number = node.is_integer() || node.is_floating_point();
  if (!is_number || !value || !(*value >= range.low && *value <= range.high)) {
    refuse(key, words(range),
           remedy.empty() ? "write a number inside this range, in the unit that the key names"
                          : std::string(remedy));
  }
  return *value;
}

double Section::number(std::string_view key, Range range, std::string_view remedy) {
  return finite_number(need(key, words(range), remedy), key, range, remedy);
}

double Section::number_or(std::string_view key, double otherwise, Range range) {
  const toml::node* node = find(key);
  return node == nullptr ? otherwise : finite_number(*node, key, range, "");
}

int Section::integer(std::string_view key, int low, int high, std::string_view remedy) {
  const Range range{static_cast<double>(low), static_cast<double>(high)};
  const toml::node& node = need(key, "a whole number, " + words(range), remedy);
  if (!node.is_integer()) {
    refuse(key, "a whole number, " + words(range), "write it without a decimal point");
  }
  return static_cast<int>(finite_number(node, key, range, remedy));
}

int Section::integer_or(std::string_view key, int otherwise, int low, int high) {
  if (!has(key)) {
    known_.emplace_back(key);
    return otherwise;
  }
  return integer(key, low, high);
}

std::array<double, 2> Section::pair(std::string_view key, Range range, std::string_view remedy) {
  const std::string allowed = "[minimum, maximum], each " + words(range);
  const toml::array* array = need(key, allowed, remedy).as_array();
  if (array == nullptr || array->size() != 2) refuse(key, allowed, "write two numbers in brackets");
  return {finite_number(*array->get(0), key, range, remedy),
          finite_number(*array->get(1), key, range, remedy)};
}

std::array<double, 3> Section::triple(std::string_view key, Range range, std::string_view remedy) {
  const std::string allowed = "[x, y, z], each " + words(range);
  const toml::array* array = need(key, allowed, remedy).as_array();
  if (array == nullptr || array->size() != 3) {
    refuse(key, allowed, "write three numbers in brackets");
  }
  return {finite_number(*array->get(0), key, range, remedy),
          finite_number(*array->get(1), key, range, remedy),
          finite_number(*array->get(2), key, range, remedy)};
}

std::array<double, 3> Section::triple_or(std::string_view key, std::array<double, 3> otherwise,
                                         Range range) {
  return find(key) == nullptr ? otherwise : triple(key, range);
}

std::vector<double> Section::numbers(std::string_view key, std::size_t min, std::size_t max,
                                     Range range, std::string_view remedy) {
  const std::string count =
      min == max ? std::to_string(min) : std::to_string(min) + " to " + std::to_string(max);
  const std::string allowed = count + " numbers in brackets, each " + words(range);
  const toml::array* array = need(key, allowed, remedy).as_array();
  if (array == nullptr) refuse(key, allowed, "write numbers in brackets, with commas between");
  if (array->size() < min || array->size() > max) {
    throw ConfigError({.file = file_,
                       .line = static_cast<int>(array->source().begin.line),
                       .key = full_name(key),
                       .value = std::to_string(array->size()) + " numbers",
                       .allowed = allowed,
                       .remedy = remedy.empty() ? "add or remove numbers" : std::string(remedy)});
  }
  std::vector<double> out;
  for (const toml::node& node : *array) {
    const auto value = node.value<double>();
    const bool is_number = node.is_integer() || node.is_floating_point();
    if (!is_number || !value || !(*value >= range.low && *value <= range.high)) {
      throw ConfigError(
          {.file = file_,
           .line = static_cast<int>(node.source().begin.line),
           .key = full_name(key) + "[" + std::to_string(out.size()) + "]",
           .value = written(node),
           .allowed = words(range),
           .remedy = "write a number inside this range, in the unit that the key names"});
    }
    out.push_back(*value);
  }
  return out;
}

std::vector<std::string> Section::texts(std::string_view key, std::size_t count,
                                        std::string_view remedy) {
  const std::string allowed = std::to_string(count) + " texts in brackets";
  const toml::array* array = need(key, allowed, remedy).as_array();
  if (array == nullptr || array->size() != count) refuse(key, allowed, std::string(remedy));
  std::vector<std::string> out;
  for (const toml::node& node : *array) {
    const auto value = node.value<std::string>();
    if (!value || value->empty()) refuse(key, allowed, std::string(remedy));
    out.push_back(*value);
  }
  return out;
}

bool Section::truth_or(std::string_view key, bool otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (!node->is_boolean()) refuse(key, "true, false", "write true or false without quotes");
  return node->value_or(otherwise);
}

std::string Section::text(std::string_view key, std::string_view remedy) {
  const toml::node& node = need(key, "text in quotes", remedy);
  const auto value = node.value<std::string>();
  if (!node.is_string() || value->empty()) {
    refuse(key, "text in quotes, not empty", remedy.empty() ? "name it" : std::string(remedy));
  }
  return *value;
}

std::string Section::text_or(std::string_view key, std::string_view otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::string(otherwise);
  if (!node->is_string()) refuse(key, "text in quotes", "put the value in quotes");
  return node->value_or(std::string(otherwise));
}

int Section::choice(std::string_view key, std::initializer_list<std::string_view> choices) {
  const toml::node& node = need(key, words(choices), "");
  const auto value = node.is_string() ? node.value<std::string>() : std::nullopt;
  const auto at = value ? std::find(choices.begin(), choices.end(), *value) : choices.end();
  if (at == choices.end()) refuse(key, words(choices), "choose one of the words, in quotes");
  return static_cast<int>(at - choices.begin());
}

int Section::choice_or(std::string_view key, int otherwise,
                       std::initializer_list<std::string_view> choices) {
  if (has(key)) return choice(key, choices);
  known_.emplace_back(key);
  return otherwise;
}

Section Section::section(std::string_view key) {
  const toml::node& node = need(key, "a table [" + full_name(key) + "]", "");
  if (!node.is_table()) refuse(key, "a table", "write it as [" + full_name(key) + "]");
  return {file_, *node.as_table(), full_name(key)};
}

Section Section::section_or(std::string_view key) {
  if (has(key)) return section(key);
  known_.emplace_back(key);
  return {file_, kNothing, full_name(key)};
}

std::vector<Section> Section::sections_or(std::string_view key) {
  std::vector<Section> out;
  const toml::node* node = find(key);
  if (node == nullptr) return out;
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    refuse(key, "an array of tables", "write each as [[" + full_name(key) + "]]");
  }
  for (const toml::node& element : *array) {
    out.emplace_back(file_, *element.as_table(),
                     full_name(key) + "[" + std::to_string(out.size()) + "]");
  }
  return out;
}

void Section::finish() const {
  for (const auto& [key, node] : *table_) {
    const std::string_view name = key.str();
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    std::string allowed, nearest;
    std::size_t best = kSimilar;
    for (const std::string& known : known_) {
      allowed += (allowed.empty() ? "" : ", ") + known;
      if (const std::size_t d = distance(name, known); d < best) {
        best = d;
        nearest = known;
      }
    }
    throw ConfigError({.file = file_,
                       .line = static_cast<int>(key.source().begin.line),
                       .key = full_name(name),
                       .value = written(node),
                       .allowed = allowed,
                       .remedy = nearest.empty() ? "remove this key: nothing reads it"
                                                 : "did you mean " + nearest + "?"});
  }
}

}  // namespace meridian::config
