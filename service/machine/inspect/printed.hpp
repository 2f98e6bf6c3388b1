// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

namespace meridian::inspect {

/// As std::snprintf prints, at most 399 characters.
template <class... Values>
[[nodiscard]] std::string printed(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace meridian::inspect
