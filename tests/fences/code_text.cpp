// SPDX-License-Identifier: Apache-2.0
#include "fences/code_text.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace meridian::fences {
namespace {

void cover(std::string& text, std::size_t begin, std::size_t end, char by) {
  for (std::size_t i = begin; i < end && i < text.size(); ++i) {
    if (text[i] != '\n') text[i] = by;
  }
}

/// Behind the literal that begins at `at` with its quote.
std::size_t end_of_literal(const std::string& text, std::size_t at) {
  const char quote = text[at];
  std::size_t i = at + 1;
  while (i < text.size() && text[i] != quote && text[i] != '\n') i += text[i] == '\\' ? 2 : 1;
  return i + 1;
}

/// Behind the raw literal whose quote is at `at`.
std::size_t end_of_raw(const std::string& text, std::size_t at) {
  const std::size_t open = text.find('(', at);
  const std::string end = ")" + text.substr(at + 1, open - at - 1) + "\"";
  const std::size_t close = text.find(end, open);
  return close == std::string::npos ? text.size() : close + end.size();
}

bool is_in_number(const std::string& text, std::size_t at) {
  return at > 0 && std::isxdigit(static_cast<unsigned char>(text[at - 1])) != 0 &&
         at + 1 < text.size() && std::isxdigit(static_cast<unsigned char>(text[at + 1])) != 0;
}

void cover_preprocessor(std::string& text) {
  bool goes_on = false;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::size_t first = text.find_first_not_of(' ', begin);
    const bool is_line = goes_on || (first < end && text[first] == '#');
    goes_on = is_line && end > begin && text[end - 1] == '\\';
    if (is_line) cover(text, begin, end, ' ');
    begin = end + 1;
  }
}

}  // namespace

std::string code_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = std::string_view(text).substr(i);
    std::size_t end = i + 1;
    if (rest.starts_with("//") || rest.starts_with("/*")) {
      const bool is_line = rest[1] == '/';
      end = is_line ? text.find('\n', i) : text.find("*/", i) + 2;
      cover(text, i, end, ' ');
    } else if (rest.starts_with("R\"")) {
      end = end_of_raw(text, i + 1);
      cover(text, i, end, '_');
    } else if (rest[0] == '"' || (rest[0] == '\'' && !is_in_number(text, i))) {
      end = end_of_literal(text, i);
      cover(text, i, end, '_');
    }
    i = end;
  }
  cover_preprocessor(text);
  return text;
}

}  // namespace meridian::fences
