// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/programs/cl/interpreter/frame.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/text/statement.hpp"

namespace meridian::cl {

/// Patterns of a CL file: the statements between INDEX and COPY, recorded as they are read, and
/// given again under a transformation.
///
/// As the CL editor of APT means it: a pattern runs once where it is written; COPY runs it again as
/// often as it says, the first time under its transformation, then under its square, and so on.
/// A COPY inside a pattern is part of it, and so a second COPY of one INDEX repeats the first one.
/// Frames are in the unit of the file. Proof: tests/unit/cl/copy_test.cpp.
class Copies {
 public:
  static constexpr std::size_t kMaxText = 16 * 1024 * 1024;
  static constexpr std::size_t kMaxDepth = 8;
  static constexpr std::uint64_t kMaxStatements = 10'000'000;

  /// What holds where a pattern begins, to be compared with what holds where it is repeated.
  struct Start {
    std::array<double, 3> axis{};
    bool is_in_cycle = false;
  };

  /// A statement of the file, recorded where some INDEX stands before it.
  void record(const Statement& s);

  [[nodiscard]] Outcome begin_pattern(std::uint32_t number, const Start& start, std::uint32_t line);
  [[nodiscard]] Outcome end_pattern(std::uint32_t number);
  /// From the next statement on, `times` times the pattern of `number`.
  [[nodiscard]] Outcome repeat(std::uint32_t number, const Frame& step, std::uint32_t times,
                               const Start& now, std::uint32_t line);

  [[nodiscard]] bool is_repeating() const noexcept { return !passes_.empty(); }
  /// The next statement of the pattern that is repeated, where is_repeating(). It carries the line
  /// of the outermost COPY: lines of blocks never run back.
  [[nodiscard]] RecordedStatement next();
  /// To be called after every statement of a pattern: goes on to the next pass where one is over.
  /// True where the transformation changed.
  bool go_on();
  /// The transformation of all passes in force.
  [[nodiscard]] Frame transformation() const;
  /// A pass has given nothing yet.
  [[nodiscard]] bool is_at_begin() const noexcept {
    return is_repeating() && passes_.back().at == passes_.back().begin;
  }
  /// What held where the pattern that is repeated is written; where is_repeating().
  [[nodiscard]] const Start& start() const noexcept { return passes_.back().start; }

 private:
  struct Pattern {
    std::uint32_t number = 0, line = 0;
    Start start;
    std::size_t begin = 0;           ///< of its records
    std::optional<std::size_t> end;  ///< named by NOMORE; nothing: at the COPY
    bool is_lost = false;
  };
  struct Pass {
    std::size_t begin = 0, end = 0, at = 0;
    Frame step, now;
    std::uint32_t left = 0, line = 0;
    Start start;
  };
  struct Record {
    std::size_t begin = 0, size = 0;
    Statement::Source source = Statement::Source::kText;
  };

  [[nodiscard]] Pattern* find(std::uint32_t number);
  /// Where the statement stands that is being read.
  [[nodiscard]] std::size_t here() const noexcept {
    return (passes_.empty() ? records_.size() : passes_.back().at) - 1;
  }
  void lose_all();

  std::string text_;
  std::vector<Record> records_;
  std::vector<Pattern> patterns_;
  std::vector<Pass> passes_;
  std::uint64_t given_ = 0;
};

}  // namespace meridian::cl
