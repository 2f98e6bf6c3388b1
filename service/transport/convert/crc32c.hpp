// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace meridian::dds {

namespace detail {

/// Slice-by-four tables of the Castagnoli polynomial 1EDC6F41h, reflected.
[[nodiscard]] consteval std::array<std::array<std::uint32_t, 256>, 4> crc32c_tables() {
  std::array<std::array<std::uint32_t, 256>, 4> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) {
      value = (value & 1U) != 0 ? (value >> 1U) ^ 0x82F63B78U : value >> 1U;
    }
    table[0][byte] = value;
  }
  for (std::size_t slice = 1; slice < 4; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = table[slice - 1][byte];
      table[slice][byte] = (before >> 8U) ^ table[0][before & 0xFFU];
    }
  }
  return table;
}

inline constexpr auto kCrc32cTables = crc32c_tables();

}  // namespace detail

/// Returns the CRC-32C (RFC 3720, section 12.1) of `data`, continued from `seed`, the CRC of what
/// came before it; 0 starts anew. Proof: tests/unit/transport/crc32c_test.cpp, check value
/// E3069283h.
[[nodiscard]] constexpr std::uint32_t crc32c(std::span<const std::byte> data,
                                             std::uint32_t seed = 0) noexcept {
  const auto& table = detail::kCrc32cTables;
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(data[i]); };
  std::uint32_t crc = ~seed;
  std::size_t i = 0;
  for (; i + 4 <= data.size(); i += 4) {
    crc ^= at(i) | at(i + 1) << 8U | at(i + 2) << 16U | at(i + 3) << 24U;
    crc = table[3][crc & 0xFFU] ^ table[2][crc >> 8U & 0xFFU] ^ table[1][crc >> 16U & 0xFFU] ^
          table[0][crc >> 24U];
  }
  for (; i < data.size(); ++i) crc = (crc >> 8U) ^ table[0][(crc ^ at(i)) & 0xFFU];
  return ~crc;
}

}  // namespace meridian::dds
