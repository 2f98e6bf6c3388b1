// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// What the fences look at: the project's own files.
namespace meridian::fences {

struct SourceFile {
  std::string path;  ///< from the top of the project, with '/'
  std::vector<std::string> lines;
};

/// A place where a fence is broken.
struct Finding {
  std::string path;
  std::size_t line = 0;  ///< 1-based, 0: the file as a whole
  std::string message;
};

/// Text without the spaces at its begin and end.
[[nodiscard]] std::string trimmed(const std::string& text);

/// Splits text at line ends.
[[nodiscard]] std::vector<std::string> split_lines(const std::string& text);

/// Reads all files below `top`/`folder` whose name ends in one of `endings` (all if empty), in
/// order of their path. A folder that does not exist has none.
[[nodiscard]] std::vector<SourceFile> read_tree(const std::string& top, const std::string& folder,
                                                const std::vector<std::string>& endings);

/// Reads one file; throws std::runtime_error where it cannot be opened.
[[nodiscard]] SourceFile read_file(const std::string& top, const std::string& path);

/// "path:line: message", one a line.
[[nodiscard]] std::string to_text(const std::vector<Finding>& findings);

}  // namespace meridian::fences
