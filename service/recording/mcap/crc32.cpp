// SPDX-License-Identifier: Apache-2.0
#include "service/recording/mcap/crc32.hpp"

#include <array>
#include <cstddef>
#include <cstring>

namespace meridian::mcap {
namespace {

using Table = std::array<std::uint32_t, 256>;

/// Table n holds what a byte does to the sum when n bytes follow it, so that eight go at once.
[[nodiscard]] constexpr std::array<Table, 8> make_tables() {
  std::array<Table, 8> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? 0xEDB88320U : 0U);
    tables[0][byte] = rest;
  }
  for (std::size_t n = 1; n < tables.size(); ++n) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[n - 1][byte];
      tables[n][byte] = (before >> 8U) ^ tables[0][before & 0xFFU];
    }
  }
  return tables;
}

constexpr std::array<Table, 8> kTables = make_tables();

}  // namespace

void Crc32::add(std::string_view bytes) noexcept {
  std::uint32_t state = state_;
  while (bytes.size() >= 8) {
    std::array<unsigned char, 8> eight;
    std::memcpy(eight.data(), bytes.data(), eight.size());
    for (std::size_t i = 0; i < 4; ++i) {
      eight[i] ^= static_cast<unsigned char>(state >> (8 * i) & 0xFFU);
    }
    state = 0;
    for (std::size_t i = 0; i < 8; ++i) state ^= kTables[7 - i][eight[i]];
    bytes.remove_prefix(8);
  }
  for (const char byte : bytes) {
    state = (state >> 8U) ^ kTables[0][(state ^ static_cast<unsigned char>(byte)) & 0xFFU];
  }
  state_ = state;
}

}  // namespace meridian::mcap
