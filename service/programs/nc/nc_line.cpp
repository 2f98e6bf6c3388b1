// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/nc_line.hpp"

#include <algorithm>

#include "service/programs/cl/text/letters.hpp"
#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::is_blank;
using cl::is_digit;
using cl::refuse;

/// The text of one line from left to right.
class Cutter {
 public:
  Cutter(std::string_view text, Line& line) : rest_(text), line_(line) {}

  cl::Outcome cut() {
    for (skip_blanks(); !rest_.empty(); skip_blanks()) {
      if (auto done = cut_next(); !done) return done;
    }
    return {};
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  }

  void take_comment(std::string_view text) {
    if (line_.comments++ == 0) line_.comment = text;
  }

  cl::Outcome cut_next() {
    const char c = rest_.front();
    if (c == ';') {
      take_comment(rest_.substr(1));
      rest_ = {};
      return {};
    }
    if (c == '(') {
      const std::size_t stop = rest_.find(')');
      if (stop == std::string_view::npos) return refuse("a comment without its closing bracket");
      take_comment(rest_.substr(1, stop - 1));
      rest_.remove_prefix(stop + 1);
      return {};
    }
    if (c == '%' && line_.words.empty()) {
      line_.is_tape_mark = true;
      rest_ = {};
      return {};
    }
    if (c == '<' && line_.words.empty()) return take_name();
    if (c == '/' && line_.words.empty()) {
      line_.has_block_delete = true;
      rest_.remove_prefix(!has_letter_next() ? 2 : 1);
      return {};
    }
    if (cl::is_letter(c) || c == ':') return cut_word();
    return refuse_sign(c);
  }

  /// `<PART-1>` in a line of its own: the program's name.
  cl::Outcome take_name() {
    const std::size_t stop = rest_.find('>');
    if (stop == std::string_view::npos || rest_.find_first_not_of(" \t", stop + 1) < rest_.size()) {
      return refuse("a name in < > with words beside it");
    }
    take_comment(rest_.substr(1, stop - 1));
    rest_ = {};
    return {};
  }

  /// `/2 X1.`: the number of the switch stands behind the sign.
  [[nodiscard]] bool has_letter_next() const { return rest_.size() < 2 || !is_digit(rest_[1]); }

  [[nodiscard]] static cl::Outcome refuse_sign(char c) {
    if (c == '#') return refuse("a variable (#)", kMovesByCam, "variables");
    if (c == '[') return refuse("an expression ([ ])", kMovesByCam, "variables");
    if (c == ',') return refuse("a word after a comma (chamfer or rounding)", kMovesByCam, "comma");
    return refuse("what begins with " + cl::quoted(std::string_view(&c, 1)) +
                  " is no NC word with a number");
  }

  /// Words of more letters than one steer macros, jumps and messages.
  [[nodiscard]] cl::Outcome refuse_name() const {
    std::size_t size = 0;
    while (size < rest_.size() && cl::is_letter(rest_[size])) ++size;
    const std::string name(rest_.substr(0, std::min<std::size_t>(size, 16)));
    return refuse("the word " + name + " of macros and jumps is not run here", kMovesByCam, name);
  }

  cl::Outcome cut_word() {
    Word word;
    const std::string_view from = rest_;
    const std::string_view address = rest_.front() == ':' ? "O" : rest_.substr(0, 1);
    std::size_t at = 1;
    while (at < from.size() && is_blank(from[at])) ++at;
    if (at < from.size() && cl::is_letter(from[at])) return refuse_name();
    if (at < from.size() && (from[at] == '#' || from[at] == '[')) return refuse_sign(from[at]);
    if (at < from.size() && from[at] == '<') {
      return refuse("a name in < >: a subprogram or a variable of LinuxCNC", kMovesByCam, "O<");
    }
    std::size_t stop = at;
    while (stop < from.size() && (is_digit(from[stop]) || from[stop] == '.' ||
                                  (stop == at && (from[stop] == '-' || from[stop] == '+')))) {
      ++stop;
    }
    word.address = address;
    if (stop < from.size() && from[stop] == '=' && stop > at && from[at] != '-') {
      word.address = from.substr(0, stop);  // C1=90.
      at = ++stop;
      while (stop < from.size() && (cl::starts_number(from[stop]))) ++stop;
    }
    word.digits = from.substr(at, stop - at);
    word.has_point = word.digits.find('.') != std::string_view::npos;
    if (!cl::parse_number(word.digits, word.number, word.decimals)) {
      return refuse("address " + std::string(word.address) + " without a number after it");
    }
    rest_.remove_prefix(stop);
    return add(word);
  }

  cl::Outcome add(const Word& word) {
    if (word.is('N')) return {};
    if (!word.is('G') && !word.is('M') && line_.find(word.address) != nullptr) {
      if (word.is('T')) {
        return refuse(
            "two tools in one block: on some controls the first is changed and the second comes "
            "next, on others the last one counts",
            "write the tool for M6 alone, and the next one in a block after it", "T");
      }
      return refuse("address " + std::string(word.address) + " twice in one block",
                    "write one block for each");
    }
    line_.words.push_back(word);
    return {};
  }

  std::string_view rest_;
  Line& line_;
};

}  // namespace

const Word* Line::find(std::string_view address) const noexcept {
  const auto at = std::find_if(words.begin(), words.end(),
                               [address](const Word& w) { return w.address == address; });
  return at == words.end() ? nullptr : &*at;
}

bool Word::may_be_rotary() const noexcept {
  const char letter = address.front();
  if (address.size() == 1) return letter >= 'A' && letter <= 'C';
  const bool has_number = address[1] >= '0' && address[1] <= '9';
  return has_number && address != "A3" && address != "B3" && address != "C3";
}

void Line::begin(std::string_view line, std::uint32_t at) {
  number = at;
  is_tape_mark = has_block_delete = false;
  words.clear();
  names.clear();
  comment = {};
  comments = 0;
  text.assign(line);
  for (char& c : text) c = cl::capital(c);
}

cl::Outcome cut(std::string_view text, std::uint32_t number, Line& line) {
  line.begin(text, number);
  return Cutter(line.text, line).cut();
}

}  // namespace meridian::nc
