// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// What `meridian ctl tool set` takes beside its number; what is not said stays as it is. mm.
struct ToolOptions {
  std::optional<double> length, radius, corner_radius, length_wear, radius_wear;
  std::string holder;  ///< how far below the gauge line and the radius there, in turns, with commas
};

/// The options of `ctl tool set` at `command`, which are returned.
std::vector<const CLI::Option*> add_tool_options(CLI::App& command, ToolOptions& options);

/// A tool table that is asked for, and by which sum the one is known that it was made from; 0: it
/// was made from none.
struct ToolOrder {
  std::string file;  ///< text of the table; empty: the service's own file
  std::uint64_t tools_seen = 0;
};

/// The order of `words`: set or clear and a number, which make a table of the one that `machine`
/// publishes; load and a file, or none for the service's own. Prints what is wrong.
[[nodiscard]] std::optional<ToolOrder> tool_order(const std::vector<std::string>& words,
                                                  const ToolOptions& options,
                                                  const dds::MachineInfo& machine);

/// Whether `words` only ask what there is: list, or save and a file.
[[nodiscard]] bool is_tool_question(const std::vector<std::string>& words);
/// Answers such: prints the table that `machine` publishes, a line for each tool as `set` takes it,
/// * before the one numbered `in_spindle`; or writes its text to a file. The exit code.
[[nodiscard]] int answer_tool_question(const std::vector<std::string>& words,
                                       const dds::MachineInfo& machine, std::uint32_t in_spindle);

/// A line for each tool of the table that `machine` publishes.
/// Proof: tests/unit/cli/tool_options_test.cpp.
[[nodiscard]] std::string tools_text(const dds::MachineInfo& machine, std::uint32_t in_spindle);

}  // namespace meridian::cli
