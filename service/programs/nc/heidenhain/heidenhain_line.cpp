// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/heidenhain/heidenhain_line.hpp"

#include <algorithm>
#include <array>

#include "service/programs/cl/text/letters.hpp"
#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/heidenhain/heidenhain_parameters.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr bool is_space(char c) { return c == ' ' || c == '\t'; }
constexpr bool is_numeral(char c) { return c >= '0' && c <= '9'; }

/// Statements of more words than one, and those whose words are no coordinates.
constexpr std::array<std::string_view, 16> kStatements = {
    "BEGIN PGM", "END PGM",  "TOOL CALL",   "TOOL DEF",     "CYCL DEF", "CYCL CALL",
    "BLK FORM",  "FUNCTION", "CALL PGM",    "CALL LBL",     "LBL",      "PLANE",
    "TCH PROBE", "FN",       "TRANS DATUM", "PRESET SELECT"};

/// Statements whose words are cut.
constexpr std::array<std::string_view, 9> kMotions = {"L",  "LN", "LP",   "CC", "CR",
                                                      "CP", "C",  "STOP", "M"};

bool begins_with(std::string_view text, std::string_view word) {
  return text.starts_with(word) && (text.size() == word.size() || is_space(text[word.size()]));
}

class KlartextCutter {
 public:
  KlartextCutter(std::string_view text, Line& line, const Variables& variables)
      : rest_(text), line_(line), variables_(variables) {}

  cl::Outcome cut() {
    take_block_delete();
    while (!rest_.empty() && is_numeral(rest_.front())) rest_.remove_prefix(1);  // of the block
    take_block_delete();
    take_comment();
    if (rest_.empty() || rest_.front() == '*') return {};
    return cut_statement();
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && is_space(rest_.front())) rest_.remove_prefix(1);
  }

  /// `/85 M30` and `85 /M30`.
  void take_block_delete() {
    skip_blanks();
    if (rest_.empty() || rest_.front() != '/') return;
    line_.has_block_delete = true;
    rest_.remove_prefix(1);
    skip_blanks();
  }

  void take_comment() {
    const std::size_t at = rest_.find(';');
    if (at == std::string_view::npos) return;
    line_.comment = rest_.substr(at + 1);
    line_.comments = 1;
    rest_ = rest_.substr(0, at);
  }

  cl::Outcome cut_statement() {
    const bool is_numbered = rest_.size() > 1 && rest_.front() == 'N' && is_numeral(rest_[1]);
    if (is_numbered || rest_.front() == '%') {
      return refuse("a line of DIN/ISO, which is not Klartext", "output Klartext (.h)", "DIN/ISO");
    }
    for (const std::string_view statement : kStatements) {
      if (!begins_with(rest_, statement)) continue;
      line_.names.push_back({statement, rest_.substr(statement.size())});
      rest_.remove_prefix(statement.size());
      return statement == "TOOL CALL" ? cut_tool_call() : cl::Outcome();
    }
    if (rest_.starts_with("FN") && rest_.size() > 2 && is_numeral(rest_[2])) {  // FN0: Q5 = 3
      line_.names.push_back({rest_.substr(0, 2), rest_.substr(2)});
      return {};
    }
    if (length_of_parameter(rest_) > 0) {
      line_.names.push_back({rest_.substr(0, 1), rest_});
      return {};
    }
    std::size_t size = 0;
    while (size < rest_.size() && cl::is_letter(rest_[size])) ++size;
    const std::string_view word = rest_.substr(0, size);
    const bool is_motion = std::find(kMotions.begin(), kMotions.end(), word) != kMotions.end();
    if (!is_motion) {
      const std::string name(word.empty() ? rest_.substr(0, 12) : word.substr(0, 16));
      return refuse(name + ": this word of Klartext is not run here", kMovesByCam, name);
    }
    line_.names.push_back({word, {}});
    if (word != "M") rest_.remove_prefix(size);
    return cut_words();
  }

  /// The number, or the name, of the tool stands first.
  cl::Outcome cut_tool_call() {
    skip_blanks();
    if (!rest_.empty() && rest_.front() == 'Q') {
      return refuse("TOOL CALL by a parameter", "output tool numbers", "names");
    }
    const std::size_t stop = rest_.starts_with('"') ? rest_.find('"', 1) : std::string_view::npos;
    if (stop != std::string_view::npos) {
      Word word;
      word.address = "T";
      word.text = rest_.substr(1, stop - 1);
      line_.words.push_back(word);
      rest_.remove_prefix(stop + 1);
    }
    if (!rest_.empty() && is_numeral(rest_.front())) {
      Word word;
      word.address = "T";
      if (auto done = cut_number(word); !done) return done;
    }
    skip_blanks();
    const bool has_axis = rest_.starts_with('Z') && (rest_.size() == 1 || is_space(rest_[1]));
    if (has_axis) rest_.remove_prefix(1);
    return cut_words();
  }

  cl::Outcome cut_words() {
    for (skip_blanks(); !rest_.empty(); skip_blanks()) {
      if (auto done = cut_word(); !done) return done;
    }
    return {};
  }

  cl::Outcome cut_word() {
    std::size_t size = 0;
    while (size < rest_.size() && cl::is_letter(rest_[size])) ++size;
    for (std::size_t at = 1; at < size; ++at) {  // FQ5
      if (length_of_parameter(rest_.substr(at)) > 0) size = at;
    }
    Word word;
    word.address = rest_.substr(0, size);
    if (size == 0) {
      return refuse("what begins with " + cl::quoted(rest_.substr(0, 1)) + " is no word");
    }
    rest_.remove_prefix(size);
    if (word.address == "MBMAX") {
      line_.names.push_back({"MB MAX", {}});
      return {};
    }
    if (word.address == "FMAX" || word.address == "FAUTO" || word.address == "RL" ||
        word.address == "RR") {
      line_.names.push_back({word.address, {}});
      return {};
    }
    skip_blanks();
    if (take_spaced_name(word) || is_left_open(word)) return {};
    if (word.address == "DR" && (rest_.starts_with("2:") || rest_.starts_with("2+") ||
                                 rest_.starts_with("2-"))) {  // DR2:+0.1 of TOOL CALL
      word.address = "DR2";
      rest_.remove_prefix(rest_[1] == ':' ? 2 : 1);
    }
    const bool is_sense = word.address == "DR" && !rest_.empty() &&
                          (rest_.size() == 1 || !is_numeral(rest_[1])) &&
                          (rest_.front() == '+' || rest_.front() == '-');
    if (is_sense) {
      line_.names.push_back({rest_.front() == '+' ? "DR+" : "DR-", {}});
      rest_.remove_prefix(1);
      return {};
    }
    const bool is_incremental = word.address.size() == 2 && word.address.front() == 'I';
    if (is_incremental) {
      word.address.remove_prefix(1);
      word.distance_mode = Word::DistanceMode::kIncremental;
    }
    const std::size_t at = rest_.starts_with('+') || rest_.starts_with('-') ? 1 : 0;
    if (rest_.size() > at && rest_[at] == 'Q') return cut_parameter(word);
    return cut_number(word);
  }

  /// R, F and M without a number: what was asked for at the keyboard and not answered. The feed
  /// stays.
  [[nodiscard]] bool is_left_open(const Word& word) const {
    return (word.is('R') || word.is('F') || word.is('M')) &&
           (rest_.empty() || cl::is_letter(rest_.front())) && !rest_.starts_with('Q');
  }

  /// F MAX and F AUTO of older controls, and MB MAX: a word instead of a number.
  bool take_spaced_name(const Word& word) {
    constexpr std::array<std::array<std::string_view, 3>, 3> kSpaced = {
        {{"F", "MAX", "FMAX"}, {"F", "AUTO", "FAUTO"}, {"MB", "MAX", "MB MAX"}}};
    for (const auto& [address, text, name] : kSpaced) {
      const bool is_whole = rest_.size() <= text.size() || is_space(rest_[text.size()]);
      if (word.address != address || !rest_.starts_with(text) || !is_whole) continue;
      rest_.remove_prefix(text.size());
      line_.names.push_back({name, {}});
      return true;
    }
    return false;
  }

  /// A+Q120, B+Q121, C+Q122: the control puts there what a tilted plane asks of these axes. X+Q5:
  /// the number that a line above gave it.
  cl::Outcome cut_parameter(Word& word) {
    constexpr std::array<std::string_view, 3> kOfAxis = {"+Q120", "+Q121", "+Q122"};
    const std::size_t axis = word.address.size() == 1
                                 ? static_cast<std::size_t>(word.address.front() - 'A')
                                 : kOfAxis.size();
    const std::size_t size = std::min(rest_.find_first_of(" \t"), rest_.size());
    const std::string_view text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    word.digits = text;
    word.has_point = true;
    if (axis < kOfAxis.size() && text == kOfAxis[axis]) {
      word.distance_mode = Word::DistanceMode::kOfPlane;
    } else if (const auto number = number_of_parameter(text, variables_)) {
      word.number = *number;
    } else {
      return refuse("a Q parameter", kMovesByCam, "Q");
    }
    return add(word);
  }

  /// M128 may have an F of its own.
  [[nodiscard]] bool is_of_m128(const Word& word) const {
    if (!word.is('F') || line_.words.empty()) return false;
    const Word& before = line_.words.back();
    return before.is('M') && before.number == 128;
  }

  /// The decimal point may be a comma.
  cl::Outcome cut_number(Word& word) {
    std::size_t stop = 0;
    std::string plain;
    while (stop < rest_.size() &&
           (is_numeral(rest_[stop]) || rest_[stop] == '.' || rest_[stop] == ',' ||
            (stop == 0 && (rest_[stop] == '-' || rest_[stop] == '+')))) {
      plain.push_back(rest_[stop] == ',' ? '.' : rest_[stop]);
      ++stop;
    }
    word.digits = rest_.substr(0, stop);
    word.has_point = true;  // a number is what it says
    if (!cl::parse_number(plain, word.number, word.decimals)) {
      return refuse("word " + std::string(word.address.substr(0, 16)) +
                    " without a number after it");
    }
    rest_.remove_prefix(stop);
    return add(word);
  }

  cl::Outcome add(const Word& word) {
    if (!word.is('M') && !is_of_m128(word) && line_.find(word.address) != nullptr) {
      return refuse("word " + std::string(word.address) + " twice in one block");
    }
    line_.words.push_back(word);
    return {};
  }

  std::string_view rest_;
  Line& line_;
  const Variables& variables_;
};

}  // namespace

cl::Outcome cut_heidenhain(std::string_view text, std::uint32_t number, Line& line,
                           const Variables& variables) {
  line.begin(text, number);
  std::replace(line.text.begin(), line.text.end(), '\t', ' ');
  return KlartextCutter(line.text, line, variables).cut();
}

}  // namespace meridian::nc
