// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/text/written_text.hpp"

#include <array>
#include <cstdio>

namespace meridian::cl {

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMax = 40;
  std::string out = "'";
  for (const char c : text.substr(0, kMax)) out.push_back(c >= ' ' && c < '\x7f' ? c : '?');
  return out + (text.size() > kMax ? "...'" : "'");
}

}  // namespace meridian::cl
