// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/siemens/siemens_line.hpp"

#include <algorithm>
#include <array>

#include "service/programs/cl/text/letters.hpp"
#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::is_blank;
using cl::is_digit;
using cl::refuse;

constexpr bool is_name_sign(char c) { return cl::is_letter(c) || is_digit(c) || c == '_'; }

/// Values that say how exactly and how hard the control moves: tolerances, jerk, what F refers to.
constexpr std::array<std::string_view, 16> kSettings = {
    "ACC", "ACCLIMA", "ADIS",     "ADISPOS", "ATOL", "CTOL",  "FGREF",   "FIFOLEN",
    "FL",  "JERKLIM", "JERKLIMA", "LIMS",    "OTOL", "STOLF", "VELOLIM", "VELOLIMA"};

/// X=AC(10), C=DC(350): how a number is meant in this block alone.
struct DistanceName {
  std::string_view name;
  Word::DistanceMode mode;
  bool is_of_rotary;
};
constexpr std::array<DistanceName, 5> kDistances = {
    {{"AC", Word::DistanceMode::kAbsolute, false},
     {"IC", Word::DistanceMode::kIncremental, false},
     {"DC", Word::DistanceMode::kShortest, true},
     {"ACP", Word::DistanceMode::kUpwards, true},
     {"ACN", Word::DistanceMode::kDownwards, true}}};

bool is_setting(std::string_view name) {
  return std::find(kSettings.begin(), kSettings.end(), name) != kSettings.end();
}

class SiemensCutter {
 public:
  SiemensCutter(std::string_view text, Line& line, Variables& variables)
      : rest_(text), line_(line), variables_(variables) {}

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
  [[nodiscard]] bool is_at_begin() const { return line_.words.empty() && line_.names.empty(); }

  void take_comment(std::string_view text) {
    if (line_.comments++ == 0) line_.comment = text;
    rest_ = {};
  }

  /// Takes `sign` off the front, blanks before it too.
  bool take(char sign) {
    skip_blanks();
    if (rest_.empty() || rest_.front() != sign) return false;
    rest_.remove_prefix(1);
    return true;
  }

  std::string_view take_while(bool (*is_wanted)(char)) {
    std::size_t size = 0;
    while (size < rest_.size() && is_wanted(rest_[size])) ++size;
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  cl::Outcome cut_next() {
    const char c = rest_.front();
    if (c == ';') {
      take_comment(rest_.substr(1));
      return {};
    }
    if (c == '%' && is_at_begin()) {  // %_N_PART_MPF
      take_comment(rest_.substr(1));
      return {};
    }
    if (c == '/' && is_at_begin()) {
      line_.has_block_delete = true;
      rest_.remove_prefix(1);
      if (!rest_.empty() && is_digit(rest_.front())) rest_.remove_prefix(1);
      return {};
    }
    if (c == ':' && is_at_begin()) {  // number of a main block
      rest_.remove_prefix(1);
      (void)take_while(is_digit);
      return {};
    }
    if (c == '$' || c == '[') return refuse("a variable of the control", kMovesByCam, "variables");
    if (c == '"') return refuse("a text where a word should stand");
    if (!cl::is_letter(c) && c != '_') {
      return refuse("what begins with " + cl::quoted(std::string_view(&c, 1)) + " is no NC word");
    }
    const bool is_name =
        c == '_' || (rest_.size() > 1 && (cl::is_letter(rest_[1]) || rest_[1] == '_'));
    return is_name ? cut_name() : cut_address();
  }

  /// CR=10, _X_HOME=10, TRAORI, TRAORI(1), MSG("...").
  cl::Outcome cut_name() {
    Line::Name name;
    name.name = take_while(is_name_sign);
    if (name.name == "DEF" && is_at_begin()) {
      const std::string_view text = rest_.substr(0, rest_.find(';'));
      rest_.remove_prefix(text.size());
      return variables_.declare(text);
    }
    if (is_at_begin() && take(':')) return {};  // a label
    if (is_setting(name.name)) return cut_setting(name);
    if (take('=')) {
      if (variables_.has(name.name)) return cut_assignment(name.name);
      Word word;
      word.address = name.name;
      if (name.name != "CR" && name.name != "TURN" && name.name != "RPL") {
        return refuse("a value for " + std::string(name.name.substr(0, 16)) +
                          ", which the control alone knows",
                      kMovesByCam, "value for " + std::string(name.name.substr(0, 16)));
      }
      return cut_value(word);
    }
    if (take('(')) {
      const std::size_t stop = end_of_arguments();
      if (stop == std::string_view::npos) {
        return refuse(std::string(name.name.substr(0, 16)) + "( without its closing bracket");
      }
      name.arguments = rest_.substr(0, stop);
      rest_.remove_prefix(stop + 1);
    }
    line_.names.push_back(name);
    return {};
  }

  /// CTOL=0.01, FGREF[A]=10, ACC[X]=80.
  cl::Outcome cut_setting(const Line::Name& name) {
    if (take('[')) {
      const std::size_t stop = rest_.find(']');
      if (stop == std::string_view::npos) {
        return refuse(std::string(name.name) + "[ without its closing bracket");
      }
      rest_.remove_prefix(stop + 1);
    }
    if (take('=')) {
      const auto number = take_number_or_name(name.name);
      if (!number) return tl::make_unexpected(number.error());
    }
    line_.names.push_back(name);
    return {};
  }

  /// A number for a name: R1=5, _X=-_Y.
  cl::Outcome cut_assignment(std::string_view name) {
    const auto number = take_number_or_name(name);
    if (!number) return tl::make_unexpected(number.error());
    return variables_.set(name, *number);
  }

  /// 10.5, _X_HOME, -R1.
  Expected<double, cl::Refusal> take_number_or_name(std::string_view address) {
    skip_blanks();
    const bool is_negative = take('-');
    skip_blanks();
    double number = 0;
    const bool has_name = !rest_.empty() && (cl::is_letter(rest_.front()) || rest_.front() == '_');
    if (has_name) {
      const std::string_view name = take_while(is_name_sign);
      const auto value = variables_.find(name);
      if (!value) {
        return refuse(std::string(address.substr(0, 32)) + "=" + std::string(name.substr(0, 32)) +
                          ": no line above gives it a number",
                      kMovesByCam, "variables");
      }
      number = *value;
    } else if (!cl::parse_number(take_while([](char c) { return is_digit(c) || c == '.'; }),
                                 number)) {
      return refuse(std::string(address.substr(0, 32)) + "= without a number after it");
    }
    skip_blanks();
    if (!rest_.empty() && std::string_view("+-*/").find(rest_.front()) != std::string_view::npos) {
      return refuse("an expression", kMovesByCam, "variables");
    }
    return is_negative ? -number : number;
  }

  [[nodiscard]] std::size_t end_of_arguments() const {
    int depth = 1;
    bool is_text = false;
    for (std::size_t at = 0; at < rest_.size(); ++at) {
      const char c = rest_[at];
      if (c == '"') is_text = !is_text;
      if (is_text) continue;
      depth += c == '(' ? 1 : 0;
      depth -= c == ')' ? 1 : 0;
      if (depth == 0) return at;
    }
    return std::string_view::npos;
  }

  /// X10.5, X=10.5, A3=0.6, M1=3.
  cl::Outcome cut_address() {
    const std::string_view from = rest_;
    Word word;
    std::size_t digits = 1;
    while (digits < from.size() && is_digit(from[digits])) ++digits;
    std::size_t at = digits;
    while (at < from.size() && is_blank(from[at])) ++at;
    if (digits > 1 && at < from.size() && from[at] == '=') {
      word.address = from.substr(0, digits);
      rest_.remove_prefix(at + 1);
      if (word.address.front() == 'R') return cut_assignment(word.address);
      return cut_value(word);
    }
    word.address = from.substr(0, 1);
    rest_.remove_prefix(1);
    (void)take('=');
    return cut_value(word);
  }

  cl::Outcome cut_value(Word& word) {
    skip_blanks();
    if (!rest_.empty() && rest_.front() == '"') return cut_text(word);
    if (!is_named(rest_)) return cut_number(word);
    const std::string_view how = next_name();
    const auto* const row = std::find_if(kDistances.begin(), kDistances.end(),
                                         [how](const DistanceName& d) { return d.name == how; });
    if (row == kDistances.end()) return cut_named_number(word);
    (void)take_while(is_name_sign);
    word.distance_mode = row->mode;
    if (row->is_of_rotary && !word.may_be_rotary()) {
      return refuse(std::string(how) + " for an axis that does not turn",
                    "output AC, or the number alone");
    }
    if (!take('(')) return refuse(std::string(how) + " without its bracket");
    skip_blanks();
    if (auto done = is_named(rest_) ? cut_named_number(word) : cut_number(word); !done) return done;
    if (!take(')')) return refuse(std::string(how) + " without its closing bracket");
    return {};
  }

  /// Whether a name stands in place of a number: _X_HOME, -R1, AC(10).
  [[nodiscard]] static bool is_named(std::string_view text) {
    const bool has_sign = text.size() > 1 && text.front() == '-';
    const char first = text.empty() ? ' ' : text[has_sign ? 1 : 0];
    return cl::is_letter(first) || first == '_';
  }

  [[nodiscard]] std::string_view next_name() const {
    std::size_t size = 0;
    while (size < rest_.size() && is_name_sign(rest_[size])) ++size;
    return rest_.substr(0, size);
  }

  /// X=_X_HOME, Z=-R1.
  cl::Outcome cut_named_number(Word& word) {
    const std::string_view from = rest_;
    const auto number = take_number_or_name(word.address);
    if (!number) return tl::make_unexpected(number.error());
    word.number = *number;
    word.digits = from.substr(0, from.size() - rest_.size());
    word.has_point = true;
    return add(word);
  }

  /// T="MILL", T="12": a tool by its name, or by a name that is a number.
  cl::Outcome cut_text(Word& word) {
    const std::size_t stop = rest_.find('"', 1);
    const std::string_view text =
        stop == std::string_view::npos ? std::string_view() : rest_.substr(1, stop - 1);
    if (!word.is('T') || text.empty()) {
      return refuse(
          std::string(word.address) + "=" + cl::quoted(rest_) + ": a name where a number is needed",
          {}, "names");
    }
    rest_.remove_prefix(stop + 1);
    if (std::all_of(text.begin(), text.end(), is_digit)) {
      word.digits = text;
      (void)cl::parse_number(text, word.number, word.decimals);
    } else {
      word.text = text;
    }
    return add(word);
  }

  cl::Outcome cut_number(Word& word) {
    std::size_t stop = 0;
    while (stop < rest_.size() && (is_digit(rest_[stop]) || rest_[stop] == '.' ||
                                   (stop == 0 && (rest_[stop] == '-' || rest_[stop] == '+')))) {
      ++stop;
    }
    word.digits = rest_.substr(0, stop);
    word.has_point = true;  // a number is what it says, with a point or without
    if (!cl::parse_number(word.digits, word.number, word.decimals)) {
      return refuse("address " + std::string(word.address.substr(0, 16)) +
                    " without a number after it");
    }
    rest_.remove_prefix(stop);
    if (!rest_.empty() && std::string_view("+-*/").find(rest_.front()) != std::string_view::npos) {
      return refuse("an expression", kMovesByCam, "variables");
    }
    return add(word);
  }

  /// `M1=3` and `S1=500` are of the first spindle.
  cl::Outcome add(Word word) {
    if (word.is('N')) return {};
    if (word.address == "M1" || word.address == "S1") word.address = word.address.substr(0, 1);
    if (!word.is('G') && !word.is('M') && line_.find(word.address) != nullptr) {
      return refuse("address " + std::string(word.address) + " twice in one block");
    }
    line_.words.push_back(word);
    return {};
  }

  std::string_view rest_;
  Line& line_;
  Variables& variables_;
};

}  // namespace

std::span<const std::string_view> setting_names() noexcept { return kSettings; }

cl::Outcome cut_siemens(std::string_view text, std::uint32_t number, Line& line,
                        Variables& variables) {
  line.begin(text, number);
  return SiemensCutter(line.text, line, variables).cut();
}

}  // namespace meridian::nc
