// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "service/programs/cl/dialect.hpp"
#include "service/programs/cl/text/line_source.hpp"

namespace meridian::cl {

/// One argument of a statement: a number or a word. `text` is as written.
struct Argument {
  std::string_view text;
  double number = 0;
  bool is_number = false;
  std::uint8_t decimals = 0;  ///< of a number: digits after its point
};

/// One logical line of a CL file, continuation lines joined: MAJOR / argument, argument ...
/// All views are good until the next statement is read.
struct Statement {
  static constexpr std::size_t kMaxArguments = 64;

  /// What the statement was cut from.
  enum class Source : std::uint8_t {
    kText,
    kCommentData,  ///< `$$->`
    kCatiaMatrix   ///< `$$*CATIA0`: the twelve numbers of the comments after it
  };
  /// What is wrong with the list of its arguments; of two faults the first of these.
  enum class ArgumentFault : std::uint8_t {
    kNone,
    kEmpty,   ///< a comma with nothing before or after it
    kTooMany  ///< more than kMaxArguments: the others are left out
  };

  std::uint32_t line = 0;  ///< of its first physical line
  std::string_view major;  ///< in capitals; empty where it begins with a number or a sign
  std::string_view rest;   ///< behind the major word and its slash, as written
  Source source = Source::kText;
  ArgumentFault fault = ArgumentFault::kNone;
  std::size_t argument_count = 0;  ///< none for words whose rest is free text
  std::size_t number_count = 0;    ///< of the arguments
  std::array<Argument, kMaxArguments> arguments;

  [[nodiscard]] bool all_numbers() const noexcept {
    return number_count == argument_count && fault == ArgumentFault::kNone;
  }
  [[nodiscard]] bool has_empty_argument() const noexcept { return fault == ArgumentFault::kEmpty; }
  /// The number of a statement such as SPINDL/RPM,1000,CLW, wherever it stands; null unless there
  /// is just one.
  [[nodiscard]] const Argument* only_number() const noexcept;
  /// True where some argument is this word (in capitals; compared without regard to case).
  [[nodiscard]] bool has_word(std::string_view word) const noexcept;
};

/// A statement that was read before, without its line end and comment.
struct RecordedStatement {
  std::string_view text;
  std::uint32_t line = 0;
  Statement::Source source = Statement::Source::kText;
};

/// Joins physical lines into statements and cuts them into words and numbers.
///
/// `$` continues a statement on the next line, with or without a comma before it; what stands
/// behind it on its line is ignored. `$$` begins a comment. Comments that carry data are given out
/// as statements: `$$-> WORD / ...` (with its own continuation) and the matrix of `$$*CATIA0`.
/// A statement number (`N22`, and a comma behind it or not) is taken off the word after it.
class StatementReader {
 public:
  enum class Outcome : std::uint8_t {
    kStatement,
    kEnd,
    kCutOff,   ///< the text ends where a `$` promises another line
    kBinary,   ///< a control character that no text has
    kTooLong,  ///< a line beyond LineSource::kLongestLine or a statement beyond kLongestStatement
    kReadError
  };
  static constexpr std::size_t kLongestStatement = 1024 * 1024;

  explicit StatementReader(LineSource& lines) : lines_(lines) {}

  [[nodiscard]] Outcome next(Statement& statement);
  /// The same statement once more; its text must live as long as `statement` is used.
  void read_again(const RecordedStatement& before, Statement& statement);
  /// Line at which kCutOff, kBinary or kTooLong was met.
  [[nodiscard]] std::uint32_t line() const noexcept { return lines_.line_number(); }
  [[nodiscard]] std::uint64_t comments() const noexcept { return comments_; }
  /// What a comment in front of the last statement showed of the system that wrote the file; asked
  /// once, then kUnknown again.
  [[nodiscard]] Dialect take_shown() noexcept { return std::exchange(shown_, Dialect::kUnknown); }

 private:
  Outcome next_line(std::string_view& line);
  Outcome join(std::string_view line, std::string_view& whole);
  bool take_comment(std::string_view comment, Statement& statement);
  void cut(std::string_view text, Statement& statement);

  LineSource& lines_;
  std::string joined_;
  std::string capitals_;
  std::array<char, 64> major_{};
  std::array<double, 12> matrix_{};
  int matrix_rows_ = -1;  ///< -1: no $$*CATIA0 open
  std::uint64_t comments_ = 0;
  Dialect shown_ = Dialect::kUnknown;
};

/// True where both are equal without regard to case; `capitals` is in capitals.
[[nodiscard]] bool is_word(std::string_view text, std::string_view capitals) noexcept;

/// True for words whose rest is free text in which `$` means nothing: PARTNO, PPRINT, INSERT, ...
[[nodiscard]] bool takes_free_text(std::string_view major) noexcept;

}  // namespace meridian::cl
