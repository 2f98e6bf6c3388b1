// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

namespace meridian::surface {

/// One line of a report, below 400 signs.
template <class... Values>
[[nodiscard]] std::string print(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace meridian::surface
