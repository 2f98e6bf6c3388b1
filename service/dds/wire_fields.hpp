// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <type_traits>

/// Fields of wire types: enumerations, arrays and texts of fixed length. Used by convert_*.cpp
/// alone.
namespace meridian::dds {

template <class Enum>
[[nodiscard]] std::uint8_t octet(Enum value) noexcept {
  static_assert(sizeof(Enum) == 1);
  return static_cast<std::uint8_t>(value);
}

/// Between a std::array and a wire array of the same length, either way.
template <class From, class To>
void copy_array(const From& from, To& to) noexcept {
  static_assert(std::size(From{}) == std::extent_v<To> || std::extent_v<From> == std::size(To{}));
  std::copy(std::begin(from), std::end(from), std::begin(to));
}

template <std::size_t N>
void copy_text(const std::string& from, char (&to)[N]) noexcept {
  const std::size_t length = std::min(from.size(), N - 1);
  std::memcpy(to, from.data(), length);
  std::memset(to + length, 0, N - length);
}

template <std::size_t N>
[[nodiscard]] std::string text_of(const char (&from)[N]) {
  return {from, ::strnlen(from, N)};
}

}  // namespace meridian::dds
