// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "service/config/machine_file.hpp"
#include "service/config/section.hpp"
#include "service/config/tool_names.hpp"

namespace meridian::config {

namespace {

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
    Tool tool;
    tool.number = section.integer("number", 1, 999'999'999);
    tool.length_mm = section.number("length_mm", {0, 1e4});
    tool.radius_mm = section.number("radius_mm", {0, 1e3});
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
    out.tools.push_back(tool);
  }
  file.finish();
  return out;
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

}  // namespace meridian::config
