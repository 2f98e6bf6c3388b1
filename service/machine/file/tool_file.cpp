// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <utility>

#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/section.hpp"
#include "service/machine/file/tool_names.hpp"

namespace meridian::config {

namespace {

constexpr std::size_t kMaxOutline = 16;  ///< corners of a holder
constexpr Range kToolLength_mm{0, 1e4}, kRadius_mm{0, 1e3}, kWear_mm{-100, 100};
constexpr const char* kHolderRemedy = "how far below the gauge line and the radius there, in turns";

std::vector<std::array<double, 2>> read_holder(Section& section) {
  std::vector<std::array<double, 2>> outline;
  if (!section.has("holder_mm")) return outline;
  const auto numbers =
      section.numbers("holder_mm", 2, 2 * kMaxOutline, {0, kToolLength_mm.high}, kHolderRemedy);
  if (numbers.size() % 2 != 0) section.refuse("holder_mm", "pairs of numbers", kHolderRemedy);
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (i > 0 && numbers[i] < numbers[i - 2]) {
      section.refuse("holder_mm", "an outline that goes down", kHolderRemedy);
    }
    outline.push_back({numbers[i], numbers[i + 1]});
  }
  return outline;
}

Tool read_tool(Section& section) {
  Tool tool;
  tool.number = section.integer("number", 1, 999'999'999);
  tool.length_mm = section.number("length_mm", kToolLength_mm);
  tool.radius_mm = section.number("radius_mm", kRadius_mm);
  tool.corner_radius_mm = section.number_or("corner_radius_mm", 0, {0, tool.radius_mm});
  tool.length_wear_mm = section.number_or("length_wear_mm", 0, kWear_mm);
  tool.radius_wear_mm = section.number_or("radius_wear_mm", 0, kWear_mm);
  tool.holder_mm = read_holder(section);
  if (tool.tip_length_mm() < 0) {
    section.refuse("length_wear_mm", "a tool that is left", "less than its length is worn off");
  }
  if (tool.cutting_radius_mm() < 0) {
    section.refuse("radius_wear_mm", "a tool that is left", "less than its radius is worn off");
  }
  return tool;
}

/// A tool table as the file has it.
struct ToolFile {
  std::vector<Tool> tools;
  std::map<std::string, std::uint32_t> names;
};

std::string in_capitals(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

ToolFile read_tools(const toml::table& table, const std::string& name) {
  Section file(name, table);
  ToolFile out;
  for (Section& section : file.sections_or("tool")) {
    Tool tool = read_tool(section);
    if (std::any_of(out.tools.begin(), out.tools.end(),
                    [&tool](const Tool& other) { return other.number == tool.number; })) {
      section.refuse("number", "every number once", "remove one of the two tools");
    }
    const std::string called = in_capitals(section.text_or("name", ""));
    const bool is_new =
        called.empty() ||
        out.names.try_emplace(called, static_cast<std::uint32_t>(tool.number)).second;
    if (!is_new) section.refuse("name", "every name once", "rename one of the two tools");
    section.finish();
    out.tools.push_back(std::move(tool));
  }
  file.finish();
  return out;
}

/// The shortest digits that come back as the same number.
[[nodiscard]] std::string digits_of(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

}  // namespace

ToolTable load_tools(const std::filesystem::path& path) {
  return ToolTable(read_tools(parse_file(path), path.string()).tools);
}

ToolTable parse_tools(std::string_view text, const std::string& name) {
  return ToolTable(read_tools(parse_text(text, name), name).tools);
}

std::map<std::string, std::uint32_t> load_tool_names(const std::filesystem::path& path) {
  return read_tools(parse_file(path), path.string()).names;
}

std::map<std::string, std::uint32_t> parse_tool_names(std::string_view text,
                                                      const std::string& name) {
  return read_tools(parse_text(text, name), name).names;
}

std::string to_text(const ToolTable& tools, const std::map<std::string, std::uint32_t>& names) {
  std::string text;
  const auto add = [&text](const char* key, double value, bool is_needed) {
    if (is_needed || value != 0) text += std::string(key) + " = " + digits_of(value) + "\n";
  };
  for (const Tool& tool : tools.tools()) {
    text += "[[tool]]\nnumber = " + std::to_string(tool.number) + "\n";
    for (const auto& [name, number] : names) {
      const bool is_its = number == static_cast<std::uint32_t>(tool.number);
      if (is_its) text += "name = \"" + name + "\"\n";
    }
    add("length_mm", tool.length_mm, true);
    add("radius_mm", tool.radius_mm, true);
    add("corner_radius_mm", tool.corner_radius_mm, false);
    add("length_wear_mm", tool.length_wear_mm, false);
    add("radius_wear_mm", tool.radius_wear_mm, false);
    if (tool.holder_mm.empty()) continue;
    text += "holder_mm = [";
    for (std::size_t i = 0; i < tool.holder_mm.size(); ++i) {
      const auto& [below, radius] = tool.holder_mm[i];
      text += (i > 0 ? ", " : "") + digits_of(below) + ", " + digits_of(radius);
    }
    text += "]\n";
  }
  return text;
}

}  // namespace meridian::config
