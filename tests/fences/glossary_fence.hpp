// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "fences/source_tree.hpp"

/// The glossary against the code: what a class is called is explained, what is explained is there.
namespace meridian::fences {

/// The terms of the page's table, one or several a row ("window, tail").
[[nodiscard]] std::vector<std::string> read_terms(const SourceFile& glossary);

/// The words of a list, empty lines and those with # passed over.
[[nodiscard]] std::set<std::string> read_words(const SourceFile& list);

/// Classes, structures and enumerations whose names have a word that is neither `plain` nor a word
/// of `terms`.
[[nodiscard]] std::vector<Finding> find_unexplained_classes(const std::vector<SourceFile>& files,
                                                            const std::vector<std::string>& terms,
                                                            const std::set<std::string>& plain);

/// Those of `terms` that no file says, as words of a text or of a name, whatever their case.
[[nodiscard]] std::vector<std::string> find_stale_terms(const std::vector<SourceFile>& files,
                                                        const std::vector<std::string>& terms);

}  // namespace meridian::fences
