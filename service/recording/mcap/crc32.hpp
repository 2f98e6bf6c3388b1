// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace meridian::mcap {

/// The CRC-32 that MCAP, zip and Ethernet use (polynomial 04C11DB7h reflected), of bytes as they
/// come. Proof: tests/unit/mcap/crc32_test.cpp.
class Crc32 {
 public:
  void add(std::string_view bytes) noexcept;
  [[nodiscard]] std::uint32_t sum() const noexcept { return ~state_; }

 private:
  std::uint32_t state_ = ~std::uint32_t{0};
};

[[nodiscard]] inline std::uint32_t crc32_of(std::string_view bytes) noexcept {
  Crc32 crc;
  crc.add(bytes);
  return crc.sum();
}

}  // namespace meridian::mcap
