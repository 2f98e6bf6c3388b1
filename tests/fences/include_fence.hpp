// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "fences/source_tree.hpp"

/// Who may know whom: every #include is an arrow from a room to a room or to a library, and the
/// allowed arrows are data (allowed_includes.txt).
namespace meridian::fences {

/// Room -> rooms, libraries and single headers that its files may include.
using AllowedIncludes = std::map<std::string, std::set<std::string>>;

/// Reads lines "ROOM: NAME NAME ..."; '#' starts a comment. Throws std::runtime_error on others.
[[nodiscard]] AllowedIncludes read_allowed_includes(const SourceFile& file);

/// The room of a file: "planner" for include/meridian/planner and service/core/planner, "base" for
/// files right in include/meridian, "service/NAME" or "service/FLOOR/NAME" for the rest.
[[nodiscard]] std::string room_of_file(const std::string& path);

/// Where an include line leads, `written` with its quotes or brackets: a room as above, "idl" for
/// generated wire types, "generated" for a header that CMake fills in, a library ("eigen",
/// "spdlog", ...), or a part of the standard library
/// ("std", "std.io", "std.threads", "posix"). Empty: nobody knows it.
[[nodiscard]] std::string target_of_include(const std::string& written);

/// All arrows of these files that are not allowed.
[[nodiscard]] std::vector<Finding> find_forbidden_includes(const std::vector<SourceFile>& files,
                                                           const AllowedIncludes& allowed);

}  // namespace meridian::fences
