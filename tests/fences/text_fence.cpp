// SPDX-License-Identifier: Apache-2.0
#include "fences/text_fence.hpp"

#include <algorithm>
#include <stdexcept>

namespace meridian::fences {

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
    if (file.lines.empty() || file.lines.front() != "// SPDX-License-Identifier: Apache-2.0") {
      findings.push_back({file.path, 1, "the first line is not the SPDX line"});
    }
    if (file.path.ends_with(".hpp") &&
        std::find(file.lines.begin(), file.lines.end(), "#pragma once") == file.lines.end()) {
      findings.push_back({file.path, 0, "no #pragma once"});
    }
  }
  return findings;
}

}  // namespace meridian::fences
