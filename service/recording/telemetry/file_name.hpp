// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <string>

namespace meridian::telemetry {

/// `name`, of a machine or an alarm, as part of a file's name: letters, digits, - and _ stay, all
/// else becomes _, so that it stays inside its folder.
[[nodiscard]] inline std::string plain_name(std::string name) {
  for (char& c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    if (!is_plain) c = '_';
  }
  return name;
}

}  // namespace meridian::telemetry
