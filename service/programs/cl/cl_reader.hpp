// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/programs/cl/cl_error.hpp"
#include "service/programs/cl/cl_options.hpp"
#include "service/programs/cl/cl_summary.hpp"

namespace meridian::cl {

/// Reads a CL file (APT and CLDATA text, all dialects of docs/cl-files.md) as a stream of blocks.
///
/// Memory is constant whatever the length of the file; blocks come out as soon as their statement
/// is read. Frames of the file are resolved: every pose is in the frame in force at the first
/// motion of the file (then in `options.frame`, where given). Nothing is guessed: what contradicts
/// itself is a warning, what cannot be read one way is an error. Not thread-safe; context: I/O.
class ClReader {
 public:
  /// `input` must live as long as the reader; `name` is what messages call the file.
  ClReader(std::istream& input, const std::string& name, ClReaderOptions options = {});
  /// `text` must live as long as the reader.
  ClReader(std::string_view text, const std::string& name, ClReaderOptions options = {});
  ~ClReader();
  ClReader(ClReader&&) noexcept;
  ClReader& operator=(ClReader&&) noexcept;
  ClReader(const ClReader&) = delete;
  ClReader& operator=(const ClReader&) = delete;

  /// The next block; nothing after the block of kind kEnd. An error stays until go_on().
  [[nodiscard]] Expected<std::optional<ClBlock>, ClError> next();

  /// Leaves the refused statement out, so that next() finds what else is wrong with the file; what
  /// it gives from then on is for checking alone. False where nothing more can be read.
  [[nodiscard]] bool go_on();

  /// Counts, box, feeds, tools: of what was read so far.
  [[nodiscard]] const ClSummary& summary() const noexcept;
  /// One for each kind of oddity, with the line of its first place; grows while reading.
  [[nodiscard]] const std::vector<ClWarning>& warnings() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meridian::cl
