// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "fences/source_tree.hpp"

/// Private words that may not come back in the names of types, functions and variables.
namespace meridian::fences {

struct NameRules {
  std::set<std::string> words;    ///< in lower case, that no name may have as one of its words
  std::set<std::string> allowed;  ///< whole names that may: English or foreign uses
};

/// Lines "word: WORD..." and "name: NAME..."; empty lines and those with # are passed over. Throws
/// std::runtime_error at any other.
[[nodiscard]] NameRules read_name_rules(const SourceFile& file);

/// The words of a name in lower case: `way_in_mm`, `WayIn` and `kWayIn_mm` begin with or hold
/// "way".
[[nodiscard]] std::vector<std::string> words_of(const std::string& name);

/// Names in the code of the files, not in comments and literals. Names of tests, which are
/// sentences of more than four words without '_', may say what they like.
[[nodiscard]] std::vector<Finding> find_private_names(const std::vector<SourceFile>& files,
                                                      const NameRules& rules);

}  // namespace meridian::fences
