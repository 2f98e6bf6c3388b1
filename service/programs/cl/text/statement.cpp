// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/text/statement.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "service/programs/cl/text/letters.hpp"
#include "service/programs/cl/text/number.hpp"

namespace meridian::cl {
namespace {

/// Look-ups, as every character of a file is asked.
using CharacterSet = std::array<bool, 256>;
constexpr CharacterSet kSeparators = [] {
  CharacterSet set{};
  for (const char c : {' ', '\t', ',', '/', '(', ')', '='})
    set[static_cast<unsigned char>(c)] = true;
  return set;
}();
constexpr CharacterSet kWordCharacters = [] {
  CharacterSet set{};
  for (int c = 0; c < 128; ++c) {
    const char sign = static_cast<char>(c);
    set[static_cast<std::size_t>(c)] =
        is_letter(sign) || is_digit(sign) || sign == '_' || sign == '-';
  }
  return set;
}();

bool is_word_character(char c) noexcept { return kWordCharacters[static_cast<unsigned char>(c)]; }

bool is_separator(char c) noexcept { return kSeparators[static_cast<unsigned char>(c)]; }

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view first_word(std::string_view text) noexcept {
  std::size_t size = 0;
  while (size < text.size() && is_word_character(text[size])) ++size;
  return text.substr(0, size);
}

/// Takes "N22", "N22," and "N22 ," off where a word stands behind it.
std::string_view without_number(std::string_view text) noexcept {
  if (text.size() < 3 || capital(text.front()) != 'N') return text;
  std::size_t at = 1;
  while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
  const std::size_t digits = at - 1;
  while (at < text.size() && (is_blank(text[at]) || text[at] == ',')) ++at;
  const bool has_gap = at > digits + 1;
  const bool has_word = at < text.size() && capital(text[at]) >= 'A' && capital(text[at]) <= 'Z';
  return digits > 0 && has_gap && has_word ? text.substr(at) : text;
}

const char* find(std::string_view text, char c) noexcept {
  return text.empty() ? nullptr
                      : static_cast<const char*>(std::memchr(text.data(), c, text.size()));
}

}  // namespace

bool is_word(std::string_view text, std::string_view capitals) noexcept {
  return std::equal(text.begin(), text.end(), capitals.begin(), capitals.end(),
                    [](char a, char b) { return capital(a) == b; });
}

bool takes_free_text(std::string_view major) noexcept {
  if (major.size() < 5 || capital(major.front()) == 'G') return false;
  constexpr std::array<std::string_view, 8> kWords = {"PARTNO", "PPRINT", "INSERT", "REMARK",
                                                      "TPRINT", "LETTER", "TITLES", "PPFUN"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [major](std::string_view word) { return is_word(major, word); });
}

bool Statement::has_word(std::string_view word) const noexcept {
  return std::any_of(arguments.begin(),
                     arguments.begin() + static_cast<std::ptrdiff_t>(argument_count),
                     [word](const Argument& argument) { return is_word(argument.text, word); });
}

const Argument* Statement::only_number() const noexcept {
  if (number_count != 1) return nullptr;
  for (const Argument& argument : arguments) {
    if (argument.is_number) return &argument;
  }
  return nullptr;
}

StatementReader::Outcome StatementReader::next_line(std::string_view& line) {
  switch (lines_.next(line)) {
    case LineSource::Outcome::kLine:
      return find(line, '\0') != nullptr ? Outcome::kBinary : Outcome::kStatement;
    case LineSource::Outcome::kEnd:
      return Outcome::kEnd;
    case LineSource::Outcome::kTooLong:
      return Outcome::kTooLong;
    case LineSource::Outcome::kReadError:
      break;
  }
  return Outcome::kReadError;
}

/// Takes the continuation lines of `line` in; `whole` is the statement without comment.
StatementReader::Outcome StatementReader::join(std::string_view line, std::string_view& whole) {
  const char* dollar = find(line, '$');
  if (dollar == nullptr) {
    whole = line;
    return Outcome::kStatement;
  }
  joined_.clear();
  while (true) {
    const bool comment =
        dollar != nullptr && dollar + 1 != line.data() + line.size() && dollar[1] == '$';
    joined_.append(line.data(), dollar != nullptr ? dollar : line.data() + line.size());
    if (dollar == nullptr || comment) break;
    joined_.push_back(' ');
    if (joined_.size() > kLongestStatement) return Outcome::kTooLong;
    do {  // comments and empty lines may stand between the lines of a statement
      const Outcome outcome = next_line(line);
      if (outcome != Outcome::kStatement) {
        return outcome == Outcome::kEnd ? Outcome::kCutOff : outcome;
      }
      line = trimmed(line);
    } while (line.empty() || line.starts_with("$$"));
    dollar = find(line, '$');
  }
  whole = joined_;
  return Outcome::kStatement;
}

/// True where the comment completes a $$*CATIA0 matrix, which `statement` then holds.
bool StatementReader::take_comment(std::string_view comment, Statement& statement) {
  ++comments_;
  constexpr std::uint64_t kHead = 100;  // systems name themselves at the head of a file
  if (comments_ <= kHead && shown_ == Dialect::kUnknown) shown_ = shown_by_text(comment);
  if (comment.starts_with("*CATIA0")) {
    matrix_rows_ = 0;
    statement.line = lines_.line_number();
    return false;
  }
  if (matrix_rows_ < 0) return false;
  const std::uint32_t line = statement.line;
  cut(comment, statement);
  statement.line = line;
  if (!statement.major.empty() || !statement.all_numbers() || statement.argument_count != 4) {
    if (matrix_rows_ > 0) matrix_rows_ = -1;  // the lines before the rows name the axis system
    return false;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    matrix_[static_cast<std::size_t>(matrix_rows_) * 4 + i] = statement.arguments[i].number;
  }
  if (++matrix_rows_ < 3) return false;
  matrix_rows_ = -1;
  statement.major = {};
  statement.source = Statement::Source::kCatiaMatrix;
  statement.argument_count = statement.number_count = 12;
  for (std::size_t i = 0; i < 12; ++i) statement.arguments[i] = {{}, matrix_[i], true, 0};
  return true;
}

void StatementReader::cut(std::string_view text, Statement& out) {
  using Fault = Statement::ArgumentFault;
  out.source = Statement::Source::kText;
  out.fault = Fault::kNone;
  out.argument_count = out.number_count = 0;
  text = without_number(trimmed(text));
  std::string_view major =
      starts_number(text.empty() ? ' ' : text.front()) ? std::string_view{} : first_word(text);
  std::size_t used = major.size();
  if (is_word(major, "TOOL")) {  // TOOL PATH/ is the only major word of two
    const std::string_view remainder = trimmed(text.substr(used));
    if (is_word(first_word(remainder), "PATH")) {
      used = static_cast<std::size_t>(remainder.data() - text.data()) + 4;
      major = "TOOL PATH";
    }
  }
  if (major.size() <= major_.size() &&
      std::any_of(major.begin(), major.end(), [](char c) { return c >= 'a' && c <= 'z'; })) {
    std::transform(major.begin(), major.end(), major_.begin(), capital);
    major = {major_.data(), major.size()};
  }
  out.major = major;
  std::string_view rest = text.substr(used);
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  if (!rest.empty() && rest.front() == '/') rest.remove_prefix(1);
  out.rest = rest;
  if (takes_free_text(major)) return;

  const char* at = rest.data();
  const char* const end = at + rest.size();
  bool after_comma = false;
  while (at != end) {
    const char c = *at;
    if (is_separator(c)) {
      if (c == ',') {
        if (after_comma || out.argument_count == 0) out.fault = Fault::kEmpty;
        after_comma = true;
      }
      ++at;
      continue;
    }
    const char* const start = at;
    while (at != end && !is_separator(*at)) ++at;
    after_comma = false;
    if (out.argument_count == Statement::kMaxArguments) {
      if (out.fault == Fault::kNone) out.fault = Fault::kTooMany;
      return;
    }
    Argument& argument = out.arguments[out.argument_count++];
    argument.text = {start, static_cast<std::size_t>(at - start)};
    argument.is_number =
        starts_number(*start) && parse_number(argument.text, argument.number, argument.decimals);
    out.number_count += argument.is_number ? 1 : 0;
  }
  if (after_comma) out.fault = Fault::kEmpty;
}

void StatementReader::read_again(const RecordedStatement& before, Statement& statement) {
  statement.line = before.line;
  cut(before.text, statement);
  statement.source = before.source;
}

StatementReader::Outcome StatementReader::next(Statement& statement) {
  std::string_view line;
  while (true) {
    const Outcome outcome = next_line(line);
    if (outcome != Outcome::kStatement) return outcome;
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    if (line.empty()) continue;
    const bool comment = line.starts_with("$$");
    const bool data = comment && line.substr(2).starts_with("->");
    if (comment && !data) {
      if (take_comment(line.substr(2), statement)) return Outcome::kStatement;
      continue;
    }
    matrix_rows_ = -1;
    statement.line = lines_.line_number();
    if (data) line.remove_prefix(4);
    std::string_view whole = line;
    const bool is_point = capital(line.front()) == 'G' || starts_number(line.front());
    if (data || is_point || !takes_free_text(first_word(without_number(line)))) {
      const Outcome joined = join(line, whole);
      if (joined != Outcome::kStatement) return joined;
    }
    cut(whole, statement);
    if (data) statement.source = Statement::Source::kCommentData;
    if (statement.major.empty() && statement.rest.empty()) continue;
    return Outcome::kStatement;
  }
}

}  // namespace meridian::cl
