// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "service/programs/cl/program_source.hpp"
#include "service/programs/cl/text/line_source.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// An NC program with tool-centre control, in ISO and Fanuc words, as the same blocks that a CL
/// file gives: docs/nc-programs.md.
class NcProgram final : public cl::ProgramSource {
 public:
  /// `lines` must live as long as the program. `reason`: why the text is taken for one.
  NcProgram(cl::LineSource& lines, std::string name, const cl::ClReaderOptions& options,
            std::string_view reason, std::shared_ptr<const MachineAxes> machine,
            NamedTools named_tools);

  [[nodiscard]] Result read(Blocks& out) override;
  [[nodiscard]] bool is_done() const noexcept override { return is_done_; }
  [[nodiscard]] cl::ClSummary& summary() override { return state_.cl.summary; }
  [[nodiscard]] const std::vector<cl::ClWarning>& warnings() const noexcept override {
    return state_.cl.remarks.warnings();
  }
  void warn(std::string_view key, std::uint32_t line, const std::string& message) override;
  [[nodiscard]] cl::ClError error(std::uint32_t line, const cl::Refusal& refusal) const override;

 private:
  [[nodiscard]] Result finish(Blocks& out);
  [[nodiscard]] cl::Outcome check_whole(std::uint32_t last_line);
  [[nodiscard]] cl::Outcome take(std::string_view text);
  [[nodiscard]] cl::Outcome take_tape_mark();
  [[nodiscard]] cl::Outcome take_block();
  [[nodiscard]] bool take_program_number(const Word& word);
  void take_comments();

  cl::LineSource& lines_;
  std::string name_;
  State state_;
  Line line_;
  bool has_number_ = false, is_done_ = false;
};

}  // namespace meridian::nc
