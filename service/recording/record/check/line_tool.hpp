// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "service/recording/record/check/path/checked_path.hpp"

namespace meridian::record {

/// The tool that is in the spindle while a line of the program is cut: rows come in order.
class LineTool {
 public:
  explicit LineTool(const CheckedPath& path)
      : path_(path), length_mm_(path.begin_tool_length_mm()) {}

  /// The tool of `line`, where that stands farther on in the path; else the one before. Unit: mm.
  double length_at(std::uint32_t line) {
    if (line == line_) return length_mm_;
    line_ = line;
    const auto& elements = path_.elements();
    std::size_t at = element_;
    while (at < elements.size() && elements[at].line != line) ++at;
    if (at == elements.size()) return length_mm_;
    element_ = at;
    return length_mm_ = elements[at].tool_length_mm;
  }

 private:
  const CheckedPath& path_;
  std::size_t element_ = 0;
  std::uint32_t line_ = 0;
  double length_mm_;
};

}  // namespace meridian::record
