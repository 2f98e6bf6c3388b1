// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace meridian::record {

/// Why a recording is refused: the place, what is wrong there, and what to do about it.
struct RecordError {
  std::string file;
  std::uint64_t line = 0;  ///< 1-based; 0 where the whole file is meant
  std::string message;
  std::string remedy;  ///< empty where there is none

  /// "file:line: message; remedy".
  [[nodiscard]] std::string text() const {
    std::string all = file;
    if (line > 0) all.append(":").append(std::to_string(line));
    all.append(": ").append(message);
    if (!remedy.empty()) all.append("; ").append(remedy);
    return all;
  }
};

}  // namespace meridian::record
