// SPDX-License-Identifier: Apache-2.0
#include "fences/source_tree.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace meridian::fences {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

SourceFile read_file(const std::string& top, const std::string& path) {
  std::ifstream file(std::filesystem::path(top) / path);
  if (!file) {
    throw std::runtime_error("cannot read " + path);
  }
  std::ostringstream text;
  text << file.rdbuf();
  return {path, split_lines(text.str())};
}

std::vector<SourceFile> read_tree(const std::string& top, const std::string& folder,
                                  const std::vector<std::string>& endings) {
  namespace fs = std::filesystem;
  std::vector<SourceFile> files;
  if (!fs::exists(fs::path(top) / folder)) {
    return files;
  }
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(top) / folder)) {
    const std::string path = fs::relative(entry.path(), top).generic_string();
    const auto matches = [&](const std::string& ending) { return path.ends_with(ending); };
    if (entry.is_regular_file() &&
        (endings.empty() || std::any_of(endings.begin(), endings.end(), matches))) {
      files.push_back(read_file(top, path));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::string to_text(const std::vector<Finding>& findings) {
  std::ostringstream text;
  for (const Finding& finding : findings) {
    text << finding.path;
    if (finding.line > 0) {
      text << ":" << finding.line;
    }
    text << ": " << finding.message << "\n";
  }
  return text.str();
}

}  // namespace meridian::fences
