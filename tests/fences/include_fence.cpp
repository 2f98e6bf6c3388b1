// SPDX-License-Identifier: Apache-2.0
#include "fences/include_fence.hpp"

#include <array>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace meridian::fences {
namespace {

/// "a/b/c.hpp" -> "a"; empty for a plain file name.
std::string first_folder(const std::string& path) {
  const auto slash = path.find('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

std::string without_prefix(const std::string& path, std::string_view prefix) {
  return path.substr(prefix.size());
}

std::string core_room(const std::string& path_in_core) {
  const std::string room = first_folder(path_in_core);
  return room.empty() ? "base" : room;
}

/// "service/NAME", or "service/FLOOR/NAME" where NAME lies on a floor of several rooms.
std::string service_room(const std::string& path_in_service) {
  static const std::set<std::string> kFloors{"analysis",   "drives",   "host",     "machine",
                                             "neighbours", "programs", "recording"};
  const std::string name = first_folder(path_in_service);
  if (!kFloors.contains(name)) {
    return "service/" + name;
  }
  return "service/" + name + "/" + first_folder(path_in_service.substr(name.size() + 1));
}

using Library = std::pair<std::string_view, std::string_view>;
constexpr std::array kLibraries{
    Library{"Eigen/", "eigen"},       Library{"unsupported/Eigen/", "eigen"},
    Library{"tl/", "expected"},       Library{"spdlog/", "spdlog"},
    Library{"fmt/", "spdlog"},        Library{"toml++/", "toml"},
    Library{"CLI/", "cli11"},         Library{"dds/", "cyclone"},
    Library{"nlohmann/", "json"},     Library{"civetweb.h", "civetweb"},
    Library{"pybind11/", "pybind11"}, Library{"zstd.h", "zstd"},
};

std::string standard_part(const std::string& name) {
  static const std::set<std::string> kIo{"iostream", "fstream", "filesystem", "cstdio", "istream",
                                         "ostream",  "iomanip", "syncstream", "print"};
  static const std::set<std::string> kThreads{"thread",       "mutex",   "condition_variable",
                                              "shared_mutex", "future",  "semaphore",
                                              "latch",        "barrier", "stop_token"};
  if (kIo.contains(name)) {
    return "std.io";
  }
  if (kThreads.contains(name)) {
    return "std.threads";
  }
  return "std";
}

}  // namespace

AllowedIncludes read_allowed_includes(const SourceFile& file) {
  AllowedIncludes allowed;
  for (const std::string& full_line : file.lines) {
    const std::string line = full_line.substr(0, full_line.find('#'));
    if (line.find_first_not_of(" \t") == std::string::npos) {
      continue;
    }
    const auto colon = line.find(':');
    if (colon == std::string::npos) {
      throw std::runtime_error(file.path + ": no colon in \"" + full_line + "\"");
    }
    std::istringstream names(line.substr(colon + 1));
    auto& row = allowed[line.substr(0, colon)];
    for (std::string name; names >> name;) {
      row.insert(name);
    }
  }
  return allowed;
}

std::string room_of_file(const std::string& path) {
  for (const std::string_view core : {"include/meridian/", "service/core/"}) {
    if (path.starts_with(core)) {
      return core_room(without_prefix(path, core));
    }
  }
  if (path.starts_with("service/")) {
    return service_room(without_prefix(path, "service/"));
  }
  return first_folder(path);
}

std::string target_of_include(const std::string& written) {
  if (written.size() < 3) {
    return "";
  }
  const std::string name = written.substr(1, written.size() - 2);
  if (name.starts_with("meridian/") && (name.ends_with(".hpp") || name.ends_with(".h"))) {
    return core_room(without_prefix(name, "meridian/"));
  }
  if (name.starts_with("service/")) {
    return room_of_file(name);
  }
  for (const auto& [prefix, library] : kLibraries) {
    if (name.starts_with(prefix)) {
      return std::string(library);
    }
  }
  if (written.front() == '"') {
    return first_folder(name).empty() ? "generated" : "";
  }
  return name.ends_with(".h") ? "posix" : standard_part(name);
}

std::vector<Finding> find_forbidden_includes(const std::vector<SourceFile>& files,
                                             const AllowedIncludes& allowed) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*(["<][^">]*[">]))");
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    const std::string room = room_of_file(file.path);
    const auto row = allowed.find(room);
    if (row == allowed.end()) {
      findings.push_back({file.path, 0, "no row for room " + room + " in allowed_includes.txt"});
      continue;
    }
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(file.lines[i], match, kInclude)) {
        continue;
      }
      const std::string target = target_of_include(match[1]);
      const std::string name = match[1].str().substr(1, match[1].length() - 2);
      if (target.empty()) {
        findings.push_back(
            {file.path, i + 1,
             "unknown include " + match[1].str() + ": write it from the top of the project"});
      } else if (target != room && !row->second.contains(target) && !row->second.contains(name)) {
        findings.push_back({file.path, i + 1, room + " may not include " + target});
      }
    }
  }
  return findings;
}

}  // namespace meridian::fences
