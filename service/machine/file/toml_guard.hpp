// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace meridian::config {

/// Why a text is not given to the TOML parser, which goes one call deeper for every part of a name
/// and every bracket: it is longer than kMaxBytes, or nested deeper than kMaxDepth.
struct TomlBomb {
  int line = 0;  ///< 1-based
  std::string words;
};

inline constexpr std::size_t kMaxTomlBytes = 1 << 20;
inline constexpr int kMaxTomlDepth = 32;

/// Looks once over `text`, strings and comments left out. Nothing: it may be parsed.
/// Proof: tests/unit/machine_file/toml_guard_test.cpp.
[[nodiscard]] std::optional<TomlBomb> find_toml_bomb(std::string_view text);

}  // namespace meridian::config
