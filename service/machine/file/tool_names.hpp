// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace meridian::config {

/// Number of every tool of a tool table that has a name, by its name in capitals. Throws
/// ConfigError where the table cannot be read. Proof: tests/unit/machine_file/tool_file_test.cpp.
[[nodiscard]] std::map<std::string, std::uint32_t> load_tool_names(
    const std::filesystem::path& path);
[[nodiscard]] std::map<std::string, std::uint32_t> parse_tool_names(std::string_view text,
                                                                    const std::string& name);

}  // namespace meridian::config
