// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "service/config/machine_file.hpp"
#include "service/config/section.hpp"

namespace meridian::config {

namespace {

ToolTable read_tools(const toml::table& table, const std::string& name) {
  Section file(name, table);
  std::vector<Tool> tools;
  for (Section& section : file.sections_or("tool")) {
    Tool tool;
    tool.number = section.integer("number", 1, 999'999'999);
    tool.length_mm = section.number("length_mm", {0, 1e4});
    tool.radius_mm = section.number("radius_mm", {0, 1e3});
    if (std::any_of(tools.begin(), tools.end(),
                    [&tool](const Tool& other) { return other.number == tool.number; })) {
      section.refuse("number", "every number once", "remove one of the two tools");
    }
    section.finish();
    tools.push_back(tool);
  }
  file.finish();
  return ToolTable(std::move(tools));
}

}  // namespace

ToolTable load_tools(const std::filesystem::path& path) {
  return read_tools(parse_file(path), path.string());
}

ToolTable parse_tools(std::string_view text, const std::string& name) {
  return read_tools(parse_text(text, name), name);
}

}  // namespace meridian::config
