// SPDX-License-Identifier: Apache-2.0
#include "fences/glossary_fence.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

#include "fences/name_fence.hpp"

namespace meridian::fences {
namespace {

/// The words of any text in lower case, one space before, between and after them.
std::string spaced(const std::string& text) {
  std::string out = " ";
  for (const std::string& word : words_of(text)) out += word + " ";
  return out;
}

}  // namespace

std::vector<std::string> read_terms(const SourceFile& glossary) {
  std::vector<std::string> terms;
  bool is_in_table = false;
  for (const std::string& line : glossary.lines) {
    if (line.starts_with("|---")) is_in_table = true;
    if (!is_in_table || !line.starts_with("| ")) continue;
    std::istringstream row(line.substr(2, line.find(" |") - 2));
    for (std::string term; std::getline(row, term, ',');) terms.push_back(trimmed(term));
  }
  return terms;
}

std::set<std::string> read_words(const SourceFile& list) {
  std::set<std::string> words;
  for (const std::string& line : list.lines) {
    if (line.starts_with('#')) continue;
    std::istringstream in(line);
    for (std::string word; in >> word;) words.insert(word);
  }
  return words;
}

std::vector<Finding> find_unexplained_classes(const std::vector<SourceFile>& files,
                                              const std::vector<std::string>& terms,
                                              const std::set<std::string>& plain) {
  std::set<std::string> known = plain;
  for (const std::string& term : terms) {
    for (const std::string& word : words_of(term)) known.insert(word);
  }
  static const std::regex declared(
      R"(^\s*(template\s*<.*>\s*)?(enum class|class|struct)\s+(\[\[\w+\]\]\s*)?([A-Z]\w+)\b(?!\s*;).*)");
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    for (std::size_t n = 0; n < file.lines.size(); ++n) {
      std::smatch found;
      if (!std::regex_match(file.lines[n], found, declared)) continue;
      for (const std::string& word : words_of(found[4].str())) {
        if (known.contains(word)) continue;
        findings.push_back(
            {file.path, n + 1, found[4].str() + ": \"" + word + "\" is not explained"});
      }
    }
  }
  return findings;
}

std::vector<std::string> find_stale_terms(const std::vector<SourceFile>& files,
                                          const std::vector<std::string>& terms) {
  std::vector<std::string> stale = terms;
  for (const SourceFile& file : files) {
    std::string text;
    for (const std::string& line : file.lines) text += line + "\n";
    const std::string said = spaced(text);
    std::erase_if(stale, [&said](const std::string& term) {
      return said.find(spaced(term)) != std::string::npos;
    });
    if (stale.empty()) break;
  }
  return stale;
}

}  // namespace meridian::fences
