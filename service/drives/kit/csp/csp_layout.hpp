// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "meridian/drive_csp.hpp"

namespace meridian::drive {

/// Objects of CiA 402 that the codec reads and writes.
enum class CspObject : std::uint16_t {
  kErrorCode = 0x603F,
  kControlword = 0x6040,
  kStatusword = 0x6041,
  kMode = 0x6060,
  kModeDisplay = 0x6061,
  kPosition = 0x6064,
  kVelocity = 0x606C,
  kTargetPosition = 0x607A,
  kVelocityOffset = 0x60B1,
  kProbeFunction = 0x60B8,
  kProbeStatus = 0x60B9,
  kProbePosition = 0x60BA
};

/// Where a number lies in process data. Bits are counted from bit 0 of the first byte on; numbers
/// are little-endian. RT.
struct CspField {
  std::size_t first_bit = 0;
  unsigned bits = 0;  ///< 0: it is not mapped

  [[nodiscard]] explicit operator bool() const noexcept { return bits > 0; }
  void put(std::span<std::uint8_t> frame, std::int64_t value) const noexcept;
  [[nodiscard]] std::uint64_t get(std::span<const std::uint8_t> frame) const noexcept;
  [[nodiscard]] std::int64_t get_signed(std::span<const std::uint8_t> frame) const noexcept;
};

/// The entries of one direction as fields. Proof: tests/unit/drive_kit/csp_layout_test.cpp.
class CspLayout {
 public:
  /// `first_index`: what is added to the objects of this axis. Throws DriveError that begins with
  /// `name` where an entry has no length, or an object is mapped twice or with a wrong length.
  CspLayout(const std::string& name, const std::vector<PdoEntry>& entries, unsigned first_index);

  /// The field of an object; one without bits where it is not mapped.
  [[nodiscard]] CspField find(CspObject object) const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept { return (bits_ + 7) / 8; }

  struct Entry {
    std::uint16_t index = 0;  ///< as of the first axis
    std::uint8_t subindex = 0;
    CspField field;
    std::optional<std::int64_t> value;
  };
  [[nodiscard]] const std::vector<Entry>& entries() const noexcept { return entries_; }

 private:
  std::vector<Entry> entries_;
  std::size_t bits_ = 0;
};

/// "607Ah:00", of an object.
[[nodiscard]] std::string object_name(unsigned index, unsigned subindex);

}  // namespace meridian::drive
