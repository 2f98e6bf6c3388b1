// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string_view>

namespace meridian::config {

inline constexpr const char* kMachineNameWords =
    "letters, digits, '.', '_' and '-', no more than 63, not '.' or '-' first";

/// Whether a machine may have this name. It is a DDS partition, where `*` and `?` stand for other
/// names, part of files' names, and goes to terminals.
/// Proof: tests/unit/machine_file/machine_name_test.cpp.
[[nodiscard]] constexpr bool is_machine_name(std::string_view name) noexcept {
  constexpr std::size_t kMaxLength = 63;
  const auto is_alphanumeric = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  if (name.empty() || name.size() > kMaxLength || name.front() == '.' || name.front() == '-') {
    return false;
  }
  return std::all_of(name.begin(), name.end(), [&](char c) {
    return is_alphanumeric(c) || c == '.' || c == '_' || c == '-';
  });
}

}  // namespace meridian::config
