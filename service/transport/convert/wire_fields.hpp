// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "service/text/printable.hpp"

/// Every message has one list of its fields, way(core field, wire field), that serves both ways.
/// Enumerations and truth values are octets on the wire, texts have a fixed length there; those
/// that come in are printable (text::printable), so that nothing behind here has to see to that.
/// Used by convert_*.cpp alone.
namespace meridian::dds {

struct ToWire {
  template <class From, class To>
  requires std::is_arithmetic_v<From>
  void operator()(const From& from, To& to) const noexcept { to = from; }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(const Enum& from, std::uint8_t& to) const noexcept {
    static_assert(sizeof(Enum) == 1);
    to = static_cast<std::uint8_t>(from);
  }
  void operator()(const bool& from, std::uint8_t& to) const noexcept { to = from ? 1 : 0; }
  template <class T, std::size_t N>
  void operator()(const std::array<T, N>& from, T (&to)[N]) const noexcept {
    std::copy(from.begin(), from.end(), to);
  }
  template <std::size_t N>
  void operator()(const char (&from)[N], char (&to)[N]) const noexcept {
    std::memcpy(to, from, N);
  }
  template <std::size_t N>
  void operator()(const std::string& from, char (&to)[N]) const noexcept {
    const std::size_t length = text::whole_characters(from, N - 1);
    std::memcpy(to, from.data(), length);
    std::memset(to + length, 0, N - length);
  }
  /// A text of fixed length on both sides.
  template <std::size_t N>
  void name(const std::array<char, N>& from, char (&to)[N]) const noexcept {
    std::copy(from.begin(), from.end(), to);
  }
  template <std::size_t N>
  void whole(const std::string& from, char (&to)[N]) const noexcept {
    (*this)(from, to);
  }
};

struct FromWire {
  template <class To, class From>
  requires std::is_arithmetic_v<From>
  void operator()(To& to, const From& from) const noexcept { to = from; }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(Enum& to, const std::uint8_t& from) const noexcept {
    to = static_cast<Enum>(from);
  }
  void operator()(bool& to, const std::uint8_t& from) const noexcept { to = from != 0; }
  template <class T, std::size_t N>
  void operator()(std::array<T, N>& to, const T (&from)[N]) const noexcept {
    std::copy(from, from + N, to.begin());
  }
  template <std::size_t N>
  void operator()(char (&to)[N], const char (&from)[N]) const noexcept {
    std::memcpy(to, from, N);
  }
  template <std::size_t N>
  void operator()(std::string& to, const char (&from)[N]) const {
    to = text::printable({from, ::strnlen(from, N)}, N);
  }
  template <std::size_t N>
  void name(std::array<char, N>& to, const char (&from)[N]) const {
    const std::string text = text::printable({from, ::strnlen(from, N)}, N - 1);
    to.fill('\0');
    std::copy(text.begin(), text.end(), to.begin());
  }
  /// The text of a file: its lines stay lines.
  template <std::size_t N>
  void whole(std::string& to, const char (&from)[N]) const {
    to.assign(from, ::strnlen(from, N));
  }
};

}  // namespace meridian::dds
