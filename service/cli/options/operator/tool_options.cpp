// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/tool_options.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/tool_names.hpp"
#include "service/protocol/tools_sum.hpp"
#include "service/text/number.hpp"
#include "service/text/printed.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cli {
namespace {

/// Prints what is wrong: nothing.
std::nullopt_t refuse_tool(const std::string& what) {
  std::fprintf(stderr, "meridian: %s\n", what.c_str());
  return std::nullopt;
}

[[nodiscard]] ToolTable reported_tools(const dds::MachineInfo& machine) {
  return config::parse_tools(machine.tool_file, "tool table of the machine");
}

[[nodiscard]] std::optional<int> tool_number(const std::string& text) {
  int number = 0;
  return text::read_number(text, number) && number > 0 ? std::optional(number) : std::nullopt;
}

/// "0,31.5,60,20" as pairs; false where it is none.
[[nodiscard]] bool read_holder(std::string_view text, std::vector<std::array<double, 2>>& outline) {
  std::vector<double> numbers;
  while (!text.empty()) {
    double& number = numbers.emplace_back();
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
    if (error != std::errc() || text == "," || (!text.empty() && text.front() != ',')) return false;
    text.remove_prefix(text.empty() ? 0 : 1);
  }
  outline.clear();
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    outline.push_back({numbers[i], numbers[i + 1]});
  }
  return !numbers.empty() && numbers.size() % 2 == 0;
}

[[nodiscard]] bool says_anything(const ToolOptions& o) {
  return o.length || o.radius || o.corner_radius || o.length_wear || o.radius_wear ||
         !o.holder.empty();
}

/// What `options` say of `tool`; false, and printed, where they are wrong.
[[nodiscard]] bool apply(const ToolOptions& options, Tool& tool) {
  tool.length_mm = options.length.value_or(tool.length_mm);
  tool.radius_mm = options.radius.value_or(tool.radius_mm);
  tool.corner_radius_mm = options.corner_radius.value_or(tool.corner_radius_mm);
  tool.length_wear_mm = options.length_wear.value_or(tool.length_wear_mm);
  tool.radius_wear_mm = options.radius_wear.value_or(tool.radius_wear_mm);
  if (options.holder.empty() || read_holder(options.holder, tool.holder_mm)) return true;
  (void)refuse_tool("--holder '" + options.holder + "': pairs of numbers with commas between");
  return false;
}

[[nodiscard]] std::optional<ToolOrder> edited(const std::string& word, int number,
                                              const ToolOptions& options,
                                              const dds::MachineInfo& machine) {
  const ToolTable reported = reported_tools(machine);
  std::vector<Tool> tools = reported.tools();
  const auto row = std::find_if(tools.begin(), tools.end(),
                                [number](const Tool& tool) { return tool.number == number; });
  const bool is_new = row == tools.end();
  if (word == "clear") {
    if (is_new) return refuse_tool("the table has no tool " + std::to_string(number));
    tools.erase(row);
  } else {
    if (is_new && (!options.length || !options.radius)) {
      return refuse_tool("tool " + std::to_string(number) +
                         " is new: say its --length and --radius");
    }
    Tool tool = is_new ? Tool{} : *row;
    tool.number = number;
    if (!apply(options, tool)) return std::nullopt;
    if (is_new) {
      tools.push_back(std::move(tool));
    } else {
      *row = std::move(tool);
    }
  }
  // One without tools is not the service's own file.
  const std::string text =
      "# Tool table of the set-up.\n" +
      config::to_text(ToolTable(tools), config::parse_tool_names(machine.tool_file, "tools"));
  (void)config::parse_tools(text, "tool table with that");
  return ToolOrder{text, stream::tools_sum(reported)};
}

[[nodiscard]] std::optional<ToolOrder> loaded(const std::string& name) {
  (void)config::load_tools(name);  // says what is wrong with it, by file and line
  std::ifstream file(name, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty())
    return refuse_tool(name + " is empty; load without a file takes the service's own");
  return ToolOrder{text, 0};
}

}  // namespace

std::vector<const CLI::Option*> add_tool_options(CLI::App& command, ToolOptions& options) {
  const auto add = [&command](const char* name, std::optional<double>& value, const char* what) {
    return command.add_option(name, value, what)->check(finite_range(-1e4, 1e4));
  };
  return {add("--length", options.length, "tool set: gauge line to tip as measured, mm"),
          add("--radius", options.radius, "tool set: radius as measured, mm"),
          add("--corner-radius", options.corner_radius, "tool set: radius of its corner, mm"),
          add("--length-wear", options.length_wear,
              "tool set: added to the length; negative: it has become shorter, mm"),
          add("--radius-wear", options.radius_wear, "tool set: added to the radius, mm"),
          command.add_option("--holder", options.holder,
                             "tool set: outline of the holder: how far below the gauge line and "
                             "the radius there, in turns, with commas between, mm")};
}

std::optional<ToolOrder> tool_order(const std::vector<std::string>& words,
                                    const ToolOptions& options, const dds::MachineInfo& machine) {
  const std::string word = words.empty() ? "" : words.front();
  const bool is_edit = (word == "set" || word == "clear") && words.size() == 2;
  const bool is_load = word == "load" && words.size() <= 2;
  if (!is_edit && !is_load) {
    return refuse_tool("tool takes set or clear and a number, load or save and a file, or list");
  }
  if (word == "set" && !says_anything(options)) return refuse_tool("tool set: say what to set");
  if (word != "set" && says_anything(options)) {
    return refuse_tool("--length, --radius and their kin are for tool set alone");
  }
  std::optional<ToolOrder> order;
  if (is_edit) {
    const auto number = tool_number(words[1]);
    if (!number) return refuse_tool("'" + words[1] + "' is no number of a tool");
    order = edited(word, *number, options, machine);
  } else {
    order = words.size() == 2 ? loaded(words[1]) : ToolOrder{};
  }
  if (order && order->file.size() > dds::kToolFileBytes) {
    return refuse_tool("the table has " + std::to_string(order->file.size()) +
                       " bytes, of at most " + std::to_string(dds::kToolFileBytes) +
                       " that a machine takes while it runs");
  }
  return order;
}

bool is_tool_question(const std::vector<std::string>& words) {
  return (words.size() == 1 && words.front() == "list") ||
         (words.size() == 2 && words.front() == "save");
}

int answer_tool_question(const std::vector<std::string>& words, const dds::MachineInfo& machine,
                         std::uint32_t in_spindle) {
  if (words.size() == 1) {
    std::fputs(tools_text(machine, in_spindle).c_str(), stdout);
    return kFine;
  }
  if (machine.tool_file.empty()) {
    (void)refuse_tool("the machine publishes no tool table: it has none, or one that is too long");
    return kVerdictNo;
  }
  if (text::write_whole(words[1], machine.tool_file)) return kFine;
  (void)refuse_tool(words[1] + ": cannot be written");
  return kVerdictNo;
}

std::string tools_text(const dds::MachineInfo& machine, std::uint32_t in_spindle) {
  std::string text;
  const ToolTable reported = reported_tools(machine);
  for (const Tool& tool : reported.tools()) {
    const bool is_in = static_cast<std::uint32_t>(tool.number) == in_spindle;
    text::append(text, "%c %3d  --length %.10g --radius %.10g", is_in ? '*' : ' ', tool.number,
                 tool.length_mm, tool.radius_mm);
    const auto add = [&text](const char* name, double value) {
      if (value != 0) text::append(text, " --%s %.10g", name, value);
    };
    add("corner-radius", tool.corner_radius_mm);
    add("length-wear", tool.length_wear_mm);
    add("radius-wear", tool.radius_wear_mm);
    for (std::size_t i = 0; i < tool.holder_mm.size(); ++i) {
      text::append(text, "%s%.10g,%.10g", i == 0 ? " --holder " : ",", tool.holder_mm[i][0],
                   tool.holder_mm[i][1]);
    }
    text += "\n";
  }
  return text;
}

}  // namespace meridian::cli
