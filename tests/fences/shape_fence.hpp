// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fences/source_tree.hpp"

/// The size of functions, how deep they are nested, how many flags a class has, and how many files
/// lie side by side. What goes beyond a bound says why, in a comment inside of it or right above it
/// (a folder is divided into rooms instead):
///
///     // Long: REASON        // Deep: REASON        // Flags: REASON
namespace meridian::fences {

inline constexpr int kMaxFunctionLines = 60;  ///< of the body, with the lines of its braces
inline constexpr int kMaxDepth = 4;           ///< nested braces, those of the body are the first
inline constexpr int kMaxFlags = 3;           ///< members of type bool, atomic ones too
inline constexpr int kMaxFiles = 25;          ///< of one folder, those of its rooms left out

/// A function with a body. Lambdas are part of the function that they are written in.
struct FunctionShape {
  std::string head;  ///< as written, on one line
  std::size_t line = 0;
  int lines = 0, depth = 0;
  bool has_long_reason = false, has_deep_reason = false;
};

/// A class, struct or union; what is nested in it counts for itself.
struct ClassShape {
  std::string head;
  std::size_t line = 0;
  int flags = 0;
  bool has_reason = false;
};

struct Shapes {
  std::vector<FunctionShape> functions;
  std::vector<ClassShape> classes;
};

/// Reads what a source defines. It knows the C++ that clang-format leaves in this project, not all
/// of it.
[[nodiscard]] Shapes read_shapes(const SourceFile& file);

/// Functions beyond kMaxFunctionLines or kMaxDepth that do not say why.
[[nodiscard]] std::vector<Finding> find_large_functions(const std::vector<SourceFile>& files);
/// Classes beyond kMaxFlags that do not say why.
[[nodiscard]] std::vector<Finding> find_flags(const std::vector<SourceFile>& files);
/// Folders of more than kMaxFiles of these files.
[[nodiscard]] std::vector<Finding> find_crowded_folders(const std::vector<SourceFile>& files);

}  // namespace meridian::fences
