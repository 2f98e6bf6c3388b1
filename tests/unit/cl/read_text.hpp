// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "service/programs/cl/cl_reader.hpp"

namespace meridian::cl {

/// What came of reading a text: all blocks before the end or the error.
struct ReadText {
  std::vector<ClBlock> blocks;
  std::string error;  ///< ClError::text(), empty where the text was read to its end
  std::uint32_t error_line = 0;
  ClSummary summary;
  std::vector<ClWarning> warnings;

  [[nodiscard]] std::vector<ClBlock> motion() const {
    std::vector<ClBlock> out;
    for (const ClBlock& b : blocks) {
      if (is_motion(b.kind)) out.push_back(b);
    }
    return out;
  }
  [[nodiscard]] bool warned_of(std::string_view part) const {
    for (const ClWarning& w : warnings) {
      if (w.message.find(part) != std::string::npos) return true;
    }
    return false;
  }
};

inline ReadText read_text(std::string_view text, const ClReaderOptions& options = {}) {
  ReadText out;
  ClReader reader(text, "part.apt", options);
  while (true) {
    const auto block = reader.next();
    if (!block) {
      out.error = block.error().text();
      out.error_line = block.error().line;
      break;
    }
    if (!*block) break;
    out.blocks.push_back(**block);
  }
  out.summary = reader.summary();
  out.warnings = reader.warnings();
  return out;
}

inline ClReaderOptions metric() {
  ClReaderOptions options;
  options.unit = LengthUnit::kMillimetre;
  return options;
}

/// Head that most tests share: metric, with a feed.
inline constexpr std::string_view kHead = "UNITS/MM\nFEDRAT/600,MMPM\n";

inline ReadText read_body(std::string_view body, const ClReaderOptions& options = {}) {
  return read_text(std::string(kHead) + std::string(body) + "FINI\n", options);
}

inline ClReaderOptions written_by(Dialect dialect) {
  ClReaderOptions options;
  options.dialect = dialect;
  return options;
}

}  // namespace meridian::cl
