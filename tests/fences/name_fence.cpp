// SPDX-License-Identifier: Apache-2.0
#include "fences/name_fence.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <sstream>
#include <stdexcept>

#include "fences/code_text.hpp"

namespace meridian::fences {
namespace {

constexpr std::size_t kWordsOfASentence = 5;

bool is_upper(char letter) { return std::isupper(static_cast<unsigned char>(letter)) != 0; }
bool is_letter(char letter) { return std::isalpha(static_cast<unsigned char>(letter)) != 0; }
bool is_of_name(char letter) {
  return letter == '_' || std::isalnum(static_cast<unsigned char>(letter)) != 0;
}

bool is_sentence(const std::string& name, const std::vector<std::string>& words) {
  return words.size() >= kWordsOfASentence && name.find('_') == std::string::npos;
}

bool is_private(const std::string& name, const NameRules& rules) {
  if (rules.allowed.contains(name)) return false;
  const std::vector<std::string> words = words_of(name);
  if (is_sentence(name, words)) return false;
  return std::any_of(words.begin(), words.end(),
                     [&rules](const std::string& word) { return rules.words.contains(word); });
}

void find_in(const SourceFile& file, const NameRules& rules, std::vector<Finding>& findings) {
  const std::string code = code_of(file.lines);
  std::size_t line = 1;
  for (std::size_t i = 0; i < code.size();) {
    if (code[i] == '\n') ++line;
    if (!is_of_name(code[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < code.size() && is_of_name(code[end])) ++end;
    const std::string name = code.substr(i, end - i);
    if (is_private(name, rules)) findings.push_back({file.path, line, "private word: " + name});
    i = end;
  }
}

}  // namespace

NameRules read_name_rules(const SourceFile& file) {
  NameRules rules;
  for (const std::string& line : file.lines) {
    if (line.empty() || line.starts_with('#')) continue;
    std::istringstream in(line);
    std::string kind;
    in >> kind;
    if (kind != "word:" && kind != "name:") {
      throw std::runtime_error(file.path + ": neither word: nor name: \"" + line + "\"");
    }
    for (std::string one; in >> one;) (kind == "word:" ? rules.words : rules.allowed).insert(one);
  }
  return rules;
}

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  bool goes_on = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (!is_letter(name[i])) {
      goes_on = false;
      continue;
    }
    const bool begins = is_upper(name[i]) && (i == 0 || !is_upper(name[i - 1]));
    if (!goes_on || begins) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
    goes_on = true;
  }
  return words;
}

std::vector<Finding> find_private_names(const std::vector<SourceFile>& files,
                                        const NameRules& rules) {
  std::vector<Finding> findings;
  for (const SourceFile& file : files) find_in(file, rules, findings);
  return findings;
}

}  // namespace meridian::fences
