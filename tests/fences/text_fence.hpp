// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <regex>
#include <string>
#include <vector>

#include "fences/source_tree.hpp"

/// Text that must not be in the project, as data (forbidden_text.txt).
namespace meridian::fences {

struct TextRule {
  std::regex path;       ///< files that it holds for
  std::regex forbidden;  ///< what no line of them may match
  std::string reason;
};

/// Reads blocks of three lines "in: REGEX", "not: REGEX", "why: WORDS"; '#' starts a comment line.
/// Throws std::runtime_error on others.
[[nodiscard]] std::vector<TextRule> read_text_rules(const SourceFile& file);

[[nodiscard]] std::vector<Finding> find_forbidden_text(const std::vector<SourceFile>& files,
                                                       const std::vector<TextRule>& rules);

/// Sources that do not start with the SPDX line, headers without #pragma once.
[[nodiscard]] std::vector<Finding> find_missing_heads(const std::vector<SourceFile>& files);

/// Lines of prose of a Markdown page that are longer than 100 characters: the reader has two pages
/// side by side. Code, tables and indented equations are left out, for they cannot be broken.
[[nodiscard]] std::vector<Finding> find_wide_prose(const std::vector<SourceFile>& pages);

}  // namespace meridian::fences
