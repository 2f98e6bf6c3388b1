// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/text/number.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace meridian::cl {
namespace {

constexpr std::array<double, 16> kPowerOfTen = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
constexpr std::size_t kLongestNumber = 64;  // digits beyond that are no coordinate

/// Exponents, Fortran's D and many digits: rare, so by the library.
bool parse_rare(std::string_view text, double& value) noexcept {
  if (text.size() > kLongestNumber) return false;
  std::array<char, kLongestNumber> plain{};
  std::size_t size = 0;
  for (const char c : text) {
    const bool allowed = (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'E' ||
                         c == 'e' || c == 'D' || c == 'd';
    if (!allowed) return false;
    if (size == 0 && c == '+' && text.size() > 1) {
      plain[size++] = '0';  // from_chars takes "01" but not "+1"
      continue;
    }
    plain[size++] = (c == 'D' || c == 'd') ? 'e' : c;
  }
  const char* const end = plain.data() + size;
  const auto result = std::from_chars(plain.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end && std::isfinite(value);
}

}  // namespace

bool parse_number(std::string_view text, double& value) noexcept {
  std::uint8_t decimals = 0;
  return parse_number(text, value, decimals);
}

bool parse_number(std::string_view text, double& value, std::uint8_t& decimal_count) noexcept {
  const char* at = text.data();
  const char* const end = at + text.size();
  const bool negative = at != end && *at == '-';
  if (negative) ++at;
  std::uint64_t digits = 0;
  const char* const whole = at;
  while (at != end && static_cast<unsigned char>(*at - '0') < 10) {
    digits = digits * 10 + static_cast<std::uint64_t>(*at++ - '0');
  }
  auto count = at - whole;
  std::ptrdiff_t decimals = 0;
  if (at != end && *at == '.') {
    const char* const fraction = ++at;
    while (at != end && static_cast<unsigned char>(*at - '0') < 10) {
      digits = digits * 10 + static_cast<std::uint64_t>(*at++ - '0');
    }
    decimals = at - fraction;
    count += decimals;
  }
  // Up to 15 digits the integer and the power of ten are exact, so one division rounds correctly.
  if (at == end && count > 0 && count <= 15) [[likely]] {
    const double magnitude =
        static_cast<double>(digits) / kPowerOfTen[static_cast<std::size_t>(decimals)];
    value = negative ? -magnitude : magnitude;
    decimal_count = static_cast<std::uint8_t>(decimals);
    return true;
  }
  decimal_count = kMaxDecimals;
  return count > 0 || at != end ? parse_rare(text, value) : false;
}

}  // namespace meridian::cl
