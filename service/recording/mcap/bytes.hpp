// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

/// How MCAP writes numbers, texts and records: little-endian, packed, appended to a string.
namespace meridian::mcap {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie");

template <class Number>
void put(std::string& out, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

/// A text or a block of bytes with its length, 32 bits, in front.
inline void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F
};

/// In front of a record's content: opcode, and the length of what follows.
inline constexpr std::size_t kRecordHead = 1 + sizeof(std::uint64_t);

inline void put_head(std::string& out, Opcode opcode, std::uint64_t length) {
  put(out, static_cast<std::uint8_t>(opcode));
  put(out, length);
}

/// Appends a record whose content is what `put_content(out)` appends.
template <class PutContent>
void put_record(std::string& out, Opcode opcode, PutContent&& put_content) {
  put_head(out, opcode, 0);
  const std::size_t begin = out.size();
  put_content(out);
  const std::uint64_t length = out.size() - begin;
  std::memcpy(out.data() + begin - sizeof length, &length, sizeof length);
}

/// Appends what `put_content(out)` appends with its length in bytes, 32 bits, in front: a list or a
/// map.
template <class PutContent>
void put_list(std::string& out, PutContent&& put_content) {
  put(out, std::uint32_t{0});
  const std::size_t begin = out.size();
  put_content(out);
  const auto length = static_cast<std::uint32_t>(out.size() - begin);
  std::memcpy(out.data() + begin - sizeof length, &length, sizeof length);
}

}  // namespace meridian::mcap
