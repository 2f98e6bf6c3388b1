// SPDX-License-Identifier: Apache-2.0
#include "fences/text_fence.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace meridian::fences {
namespace {

constexpr std::ptrdiff_t kWidestProse = 100;

/// Characters, not bytes, of text in UTF-8.
std::ptrdiff_t width(const std::string& line) {
  return std::count_if(line.begin(), line.end(), [](char byte) { return (byte & 0xC0) != 0x80; });
}

bool starts_a_fence(const std::string& line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first != std::string::npos && line.compare(first, 3, "```") == 0;
}

bool is_prose(const std::string& line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first < 4 && line[first] != '|';
}

}  // namespace

std::vector<TextRule> read_text_rules(const SourceFile& file) {
  std::vector<TextRule> rules;
  std::string path;
  std::string forbidden;
  for (const std::string& line : file.lines) {
    if (line.empty() || line.starts_with('#')) {
      continue;
    }
    if (line.starts_with("in: ")) {
      path = line.substr(4);
    } else if (line.starts_with("not: ")) {
      forbidden = line.substr(5);
    } else if (line.starts_with("why: ") && !path.empty() && !forbidden.empty()) {
      rules.push_back({std::regex(path), std::regex(forbidden), line.substr(5)});
      path.clear();
      forbidden.clear();
    } else {
      throw std::runtime_error(file.path + ": not in:, not:, why: in this order: \"" + line + "\"");
    }
  }
  return rules;
}

std::vector<Finding> find_forbidden_text(const std::vector<SourceFile>& files,
                                         const std::vector<TextRule>& rules) {
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    for (const TextRule& rule : rules) {
      if (!std::regex_search(file.path, rule.path)) {
        continue;
      }
      for (std::size_t i = 0; i < file.lines.size(); ++i) {
        if (file.lines[i].size() < 2000 && std::regex_search(file.lines[i], rule.forbidden)) {
          findings.push_back({file.path, i + 1, rule.reason});
        }
      }
    }
  }
  return findings;
}

std::vector<Finding> find_missing_heads(const std::vector<SourceFile>& files) {
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    // What is loaded into LinuxCNC's HAL is under its licence too, and lies in the folder of that.
    const bool is_of_hal = file.path.starts_with("service/drives/hal/component/") ||
                           file.path == "service/drives/hal/shared.h";
    const bool has_line =
        !file.lines.empty() &&
        (file.lines.front() == "// SPDX-License-Identifier: Apache-2.0" ||
         (is_of_hal &&
          (file.lines.front() == "// SPDX-License-Identifier: GPL-2.0-or-later" ||
           file.lines.front() == "// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later")));
    if (!has_line) {
      findings.push_back({file.path, 1, "the first line is not the SPDX line"});
    }
    if (file.path.ends_with(".hpp") &&
        std::find(file.lines.begin(), file.lines.end(), "#pragma once") == file.lines.end()) {
      findings.push_back({file.path, 0, "no #pragma once"});
    }
  }
  return findings;
}

std::vector<Finding> find_wide_prose(const std::vector<SourceFile>& pages) {
  std::vector<Finding> findings;
  for (const SourceFile& page : pages) {
    bool code = false;
    for (std::size_t i = 0; i < page.lines.size(); ++i) {
      const std::string& line = page.lines[i];
      if (starts_a_fence(line)) {
        code = !code;
      } else if (!code && is_prose(line) && width(line) > kWidestProse) {
        findings.push_back({page.path, i + 1, "prose wider than 100 characters"});
      }
    }
  }
  return findings;
}

}  // namespace meridian::fences
