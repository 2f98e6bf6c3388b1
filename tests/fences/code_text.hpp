// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace meridian::fences {

/// The lines of a C++ source joined by line ends, with the characters of comments, literals and
/// preprocessor lines replaced: those of literals by '_', the others by blanks.
[[nodiscard]] std::string code_of(const std::vector<std::string>& lines);

}  // namespace meridian::fences
