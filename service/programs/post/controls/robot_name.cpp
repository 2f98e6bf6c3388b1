// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/controls/robot_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>

namespace meridian::post {
namespace {

struct Rule {
  std::size_t longest;       ///< of a name that is given
  std::size_t longest_made;  ///< of one that is made
  bool is_upper;
  const char* language;
};

[[nodiscard]] Rule rule_of(Dialect dialect) {
  switch (dialect) {
    case Dialect::kKrl:
      return {24, 24, false, "KRL"};
    case Dialect::kLs:
      return {36, 8, true, "LS"};
    case Dialect::kRapid:
      return {32, 32, false, "RAPID"};
    default:
      return {32, 32, false, "URScript"};
  }
}

[[nodiscard]] std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// Words of any of the four languages; a name that is one of them is taken by none.
[[nodiscard]] bool is_reserved(const std::string& name) {
  constexpr std::array<std::string_view, 70> kWords = {
      "ALIAS",   "AND",      "BACKWARD", "BOOL",    "BREAK",     "CASE",    "CHAR",      "CIRC",
      "CONNECT", "CONST",    "CONTINUE", "DECL",    "DEF",       "DEFAULT", "DEFDAT",    "DEFFCT",
      "DIV",     "DO",       "ELIF",     "ELSE",    "ELSEIF",    "END",     "ENDDAT",    "ENDFCT",
      "ENDFOR",  "ENDFUNC",  "ENDIF",    "ENDLOOP", "ENDMODULE", "ENDPROC", "ENDRECORD", "ENDTEST",
      "ENDTRAP", "ENDWHILE", "ENUM",     "ERROR",   "EXIT",      "EXT",     "FALSE",     "FOR",
      "FROM",    "FUNC",     "GLOBAL",   "GOTO",    "HALT",      "IF",      "INT",       "LIN",
      "LOCAL",   "LOOP",     "MAIN",     "MOD",     "MODULE",    "NOT",     "OR",        "PERS",
      "PROC",    "PTP",      "REAL",     "RECORD",  "REPEAT",    "RETURN",  "STEP",      "TASK",
      "TEST",    "THEN",     "TRAP",     "TRUE",    "VAR",       "WHILE"};
  return std::find(kWords.begin(), kWords.end(), upper(name)) != kWords.end();
}

[[nodiscard]] bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
[[nodiscard]] bool is_digit(char c) { return c >= '0' && c <= '9'; }

[[nodiscard]] bool is_name(const std::string& name, const Rule& rule) {
  if (name.empty() || name.size() > rule.longest || !is_letter(name[0])) return false;
  for (const char c : name) {
    if (!is_letter(c) && !is_digit(c) && c != '_') return false;
  }
  return !is_reserved(name) && (!rule.is_upper || name == upper(name));
}

}  // namespace

Expected<std::string, PostError> robot_name(const PostOptions& options, const std::string& source) {
  const Rule rule = rule_of(options.dialect);
  if (!options.program_name.empty()) {
    if (is_name(options.program_name, rule)) return options.program_name;
    return tl::make_unexpected(
        PostError{0, "--program-name " + options.program_name + " is no name of a program in " +
                         rule.language + ": a letter, then letters, digits and underscores, " +
                         std::to_string(rule.longest) + " at most" +
                         (rule.is_upper ? ", capitals" : "") + ", and no word of the language"});
  }
  std::string name = std::filesystem::path(source).stem().string();
  for (char& c : name) {
    if (!is_letter(c) && !is_digit(c)) c = '_';
  }
  if (name.empty() || !is_letter(name[0]) || is_reserved(name)) name.insert(0, "P_");
  name.resize(std::min(name.size(), rule.longest_made));
  return rule.is_upper ? upper(name) : name;
}

}  // namespace meridian::post
