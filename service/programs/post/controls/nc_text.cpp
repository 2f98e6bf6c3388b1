// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/controls/nc_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace meridian::post {
namespace {

constexpr std::size_t kLongestComment = 64;

}  // namespace

std::string fixed(double value, int decimals) {
  const double min = 0.5 * std::pow(10.0, -decimals);
  std::array<char, 64> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(),
                    std::abs(value) <= min ? 0.0 : value, std::chars_format::fixed, decimals)
          .ptr;
  return {digits.data(), end};
}

double rounded(double value, int decimals) {
  const std::string text = fixed(value, decimals);
  double out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

std::string fixed_down(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return fixed(std::floor(value * scale * (1 + 1e-12)) / scale, decimals);
}

std::string harmless(std::string_view text) {
  constexpr std::string_view kKept =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789 .,+-/=_";
  std::string out(text.substr(0, kLongestComment));
  for (char& c : out) {
    if (kKept.find(c) == std::string_view::npos) c = '_';
  }
  return out;
}

}  // namespace meridian::post
