// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "service/programs/cl/interpreter/interpreter.hpp"
#include "service/programs/cl/program_source.hpp"
#include "service/programs/cl/text/statement.hpp"
#include "service/programs/cl/words/unit_by_feed.hpp"

namespace meridian::cl {

/// A CL file: statements, and what they mean.
class ClProgram final : public ProgramSource {
 public:
  /// `lines` must live as long as the program.
  ClProgram(LineSource& lines, const std::string& name, ClReaderOptions options)
      : lines_(lines),
        statements_(lines),
        interpreter_(name, std::move(options), [&lines] { return unit_by_feed_ahead(lines); }) {}

  [[nodiscard]] Result read(Blocks& out) override;
  [[nodiscard]] bool is_done() const noexcept override { return is_done_; }
  [[nodiscard]] ClSummary& summary() override;
  [[nodiscard]] const std::vector<ClWarning>& warnings() const noexcept override {
    return interpreter_.warnings();
  }
  void warn(std::string_view key, std::uint32_t line, const std::string& message) override {
    interpreter_.warn(key, line, message);
  }
  [[nodiscard]] ClError error(std::uint32_t line, const Refusal& refusal) const override {
    return interpreter_.error(line, refusal);
  }

 private:
  LineSource& lines_;
  StatementReader statements_;
  Interpreter interpreter_;
  Statement statement_;
  bool is_done_ = false;
};

}  // namespace meridian::cl
