// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/csp_layout.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "meridian/drive.hpp"

namespace meridian::drive {
namespace {

struct Length {
  CspObject object;
  unsigned bits;
};

/// Source: CiA 402-3, the tables of the objects.
constexpr std::array<Length, 12> kLengths{{{CspObject::kErrorCode, 16},
                                           {CspObject::kControlword, 16},
                                           {CspObject::kStatusword, 16},
                                           {CspObject::kMode, 8},
                                           {CspObject::kModeDisplay, 8},
                                           {CspObject::kPosition, 32},
                                           {CspObject::kVelocity, 32},
                                           {CspObject::kTargetPosition, 32},
                                           {CspObject::kVelocityOffset, 32},
                                           {CspObject::kProbeFunction, 16},
                                           {CspObject::kProbeStatus, 16},
                                           {CspObject::kProbePosition, 32}}};

[[nodiscard]] bool is_profile_object(unsigned index) { return index >= 0x6000 && index < 0xA000; }

void check(const std::string& name, const CspLayout::Entry& entry) {
  const std::string object = object_name(entry.index, entry.subindex);
  if (entry.field.bits == 0 || entry.field.bits > 64) {
    throw DriveError(name + ": PDO entry " + object + " has " + std::to_string(entry.field.bits) +
                     " bits, and must have 1 to 64; the last byte of the mapping is the length");
  }
  for (const Length& length : kLengths) {
    if (entry.index != static_cast<std::uint16_t>(length.object) || entry.subindex != 0) continue;
    if (entry.field.bits == length.bits) return;
    throw DriveError(name + ": " + object + " is mapped with " + std::to_string(entry.field.bits) +
                     " bits, and has " + std::to_string(length.bits) + " in CiA 402");
  }
}

}  // namespace

std::string object_name(unsigned index, unsigned subindex) {
  char text[16];
  std::snprintf(text, sizeof text, "%04Xh:%02X", index & 0xFFFFU, subindex & 0xFFU);
  return text;
}

CspLayout::CspLayout(const std::string& name, const std::vector<PdoEntry>& entries,
                     unsigned first_index) {
  for (const PdoEntry& mapped : entries) {
    const unsigned index = mapped.mapping >> 16;
    Entry entry;
    entry.index =
        static_cast<std::uint16_t>(is_profile_object(index) ? index - first_index : index);
    entry.subindex = static_cast<std::uint8_t>(mapped.mapping >> 8);
    entry.field = {bits_, mapped.mapping & 0xFFU};
    entry.value = mapped.value;
    check(name, entry);
    bits_ += entry.field.bits;
    if (index == 0) continue;  // padding
    const bool is_twice = std::any_of(entries_.begin(), entries_.end(), [&](const Entry& other) {
      return other.index == entry.index && other.subindex == entry.subindex;
    });
    if (is_twice) {
      throw DriveError(name + ": " + object_name(index, entry.subindex) + " is mapped twice");
    }
    entries_.push_back(entry);
  }
}

CspField CspLayout::find(CspObject object) const noexcept {
  for (const Entry& entry : entries_) {
    if (entry.index == static_cast<std::uint16_t>(object) && entry.subindex == 0) {
      return entry.field;
    }
  }
  return {};
}

void CspField::put(std::span<std::uint8_t> frame, std::int64_t value) const noexcept {
  const auto raw = static_cast<std::uint64_t>(value);
  for (unsigned i = 0; i < bits; ++i) {
    const std::size_t at = first_bit + i;
    const auto mask = static_cast<std::uint8_t>(1U << (at % 8));
    std::uint8_t& byte = frame[at / 8];
    byte = static_cast<std::uint8_t>((raw >> i & 1U) != 0 ? byte | mask : byte & ~mask);
  }
}

std::uint64_t CspField::get(std::span<const std::uint8_t> frame) const noexcept {
  std::uint64_t raw = 0;
  for (unsigned i = 0; i < bits; ++i) {
    const std::size_t at = first_bit + i;
    raw |= static_cast<std::uint64_t>(frame[at / 8] >> (at % 8) & 1U) << i;
  }
  return raw;
}

std::int64_t CspField::get_signed(std::span<const std::uint8_t> frame) const noexcept {
  const std::uint64_t raw = get(frame);
  if (bits == 0 || bits >= 64) return static_cast<std::int64_t>(raw);
  const std::uint64_t sign = std::uint64_t{1} << (bits - 1);
  return static_cast<std::int64_t>((raw ^ sign) - sign);
}

}  // namespace meridian::drive
