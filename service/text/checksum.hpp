// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace meridian::text {

/// FNV-1a, 64 bit, of bytes that may come in pieces; never 0, which says that none is known. It
/// distinguishes files, not forgeries. Proof: tests/unit/text/checksum_test.cpp.
class Checksum {
 public:
  void add(std::string_view bytes) noexcept {
    for (const char c : bytes) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  }
  /// The bytes of the number, as they lie in memory.
  void add(double value) noexcept { add({reinterpret_cast<const char*>(&value), sizeof value}); }
  [[nodiscard]] std::uint64_t sum() const noexcept { return hash_ != 0 ? hash_ : 1; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

[[nodiscard]] inline std::uint64_t checksum_of(std::string_view bytes) noexcept {
  Checksum sum;
  sum.add(bytes);
  return sum.sum();
}

}  // namespace meridian::text
