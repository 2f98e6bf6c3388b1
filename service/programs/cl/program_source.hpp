// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/programs/cl/cl_error.hpp"
#include "service/programs/cl/cl_summary.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/text/line_source.hpp"

namespace meridian::cl {

/// A program on its way from text to blocks, whatever language it is in: what ClReader asks.
class ProgramSource {
 public:
  using Blocks = std::vector<ClBlock>;
  using Result = Expected<void, ClError>;

  ProgramSource() = default;
  ProgramSource(const ProgramSource&) = delete;
  ProgramSource& operator=(const ProgramSource&) = delete;
  virtual ~ProgramSource() = default;

  /// Appends the blocks of the next statement: none, one or several; none of one that is refused.
  [[nodiscard]] virtual Result read(Blocks& out) = 0;
  /// Nothing more is read: the program ended, or its text did.
  [[nodiscard]] virtual bool is_done() const noexcept = 0;

  /// What was read so far, but for bytes and lines.
  [[nodiscard]] virtual ClSummary& summary() = 0;
  [[nodiscard]] virtual const std::vector<ClWarning>& warnings() const noexcept = 0;
  virtual void warn(std::string_view key, std::uint32_t line, const std::string& message) = 0;
  [[nodiscard]] virtual ClError error(std::uint32_t line, const Refusal& refusal) const = 0;

 protected:
  /// What ends the reading of the file, whatever else may be wrong in it.
  [[nodiscard]] tl::unexpected<ClError> final_error(std::uint32_t line, const std::string& message,
                                                    const std::string& remedy = {}) const {
    ClError all = error(line, {message, remedy, {}, 0});
    all.is_final = true;
    return tl::make_unexpected(std::move(all));
  }
};

}  // namespace meridian::cl
