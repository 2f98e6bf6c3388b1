// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "fences/source_tree.hpp"

/// What machine code asks of others: the undefined symbols of an object file that holds a function
/// with everything of ours that it reaches. An allocation, a throw or a lock anywhere below shows
/// up as a symbol.
namespace meridian::fences {

/// Undefined symbols of an object file, demangled, by nm. Throws std::runtime_error where nm fails.
[[nodiscard]] std::set<std::string> undefined_symbols(const std::string& object_file);

/// Symbols of a golden list: one a line, '#' starts a comment.
[[nodiscard]] std::set<std::string> read_symbols(const SourceFile& file);

/// Whether a symbol allocates, frees, throws, unwinds, aborts, locks, waits or talks to the world,
/// so that no golden list may hold it.
[[nodiscard]] bool is_banned(const std::string& symbol);

/// One line per symbol that one side has and the other has not; empty: equal.
[[nodiscard]] std::string difference(const std::set<std::string>& golden,
                                     const std::set<std::string>& found);

}  // namespace meridian::fences
