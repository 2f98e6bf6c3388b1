// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/programs/cl/cl_error.hpp"
#include "service/programs/cl/interpreter/modal.hpp"
#include "service/programs/cl/text/statement.hpp"

namespace meridian::cl {

/// Turns statements into blocks: finds the row of each word in the table and calls its handler. One
/// statement gives no, one or several blocks.
class Interpreter {
 public:
  using Blocks = std::vector<ClBlock>;
  using Result = Expected<void, ClError>;

  /// `look_ahead` is asked at most once, where nothing before the first motion shows the unit.
  Interpreter(std::string name, ClReaderOptions options, LookAhead look_ahead);

  /// A comment or a word showed what wrote the file.
  void see(Dialect dialect, std::uint32_t line, std::string_view what);

  /// Appends the blocks of `statement` to `out`; none of one that is refused.
  [[nodiscard]] Result take(const Statement& statement, Blocks& out);

  /// A pattern that COPY repeats gives the next statement, not the file: take() it, and then say
  /// so by go_on_repeating().
  [[nodiscard]] bool is_repeating() const noexcept { return modal_.copies.is_repeating(); }
  [[nodiscard]] RecordedStatement next_repeated() { return modal_.copies.next(); }
  void go_on_repeating();

  /// The text is at its end: checks whether the program is whole and appends its end block.
  [[nodiscard]] Result finish(std::uint32_t last_line, bool open_end, Blocks& out);

  /// True once FINI was read; what stands behind it is not looked at.
  [[nodiscard]] bool is_finished() const noexcept {
    return modal_.structure.phase == Structure::Phase::kFinished;
  }
  [[nodiscard]] ClSummary& summary();
  [[nodiscard]] const std::vector<ClWarning>& warnings() const noexcept {
    return modal_.remarks.warnings();
  }
  void warn(std::string_view key, std::uint32_t line, const std::string& message);

  [[nodiscard]] ClError error(std::uint32_t line, const Refusal& refusal) const;

 private:
  [[nodiscard]] Outcome read(const Statement& s);
  [[nodiscard]] Outcome read_comment_data(const Statement& s);
  [[nodiscard]] Outcome read_unknown(const Statement& s);
  [[nodiscard]] Outcome check_after_end(const Statement& s, std::size_t before, Blocks& out) const;
  void rest_at_end(std::uint32_t line, std::size_t before, const Blocks& out);
  [[nodiscard]] Outcome check_whole(std::uint32_t last_line, bool open_end);

  std::string name_;
  Modal modal_;
};

}  // namespace meridian::cl
