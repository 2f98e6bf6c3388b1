// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace meridian::cl {

/// Why a CL file is refused: the place, what is wrong there, and what to do about it.
struct ClError {
  std::string file;
  std::uint32_t line = 0;  ///< 1-based; 0 where the whole file is meant
  std::string message;
  std::string remedy;
  std::string group;      ///< errors of one group are alike; empty: the message without numbers
  bool is_final = false;  ///< nothing behind it can be read

  /// "file:line: message; remedy".
  [[nodiscard]] std::string text() const {
    std::string all = file;
    if (line > 0) all.append(":").append(std::to_string(line));
    all.append(": ").append(message);
    if (!remedy.empty()) all.append("; ").append(remedy);
    return all;
  }
};

/// Something that a reader of the file should know although the file is not refused for it.
struct ClWarning {
  std::uint32_t line = 0;  ///< where it was seen first
  std::string message;
  std::uint64_t count = 1;  ///< places alike
};

}  // namespace meridian::cl
