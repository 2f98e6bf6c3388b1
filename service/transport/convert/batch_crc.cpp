// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

#include "service/transport/convert/crc32c.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::dds {

// The memory of a ClBlock is its canonical encoding: no padding, the wire's field order.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(ClBlock) == 160 && offsetof(ClBlock, line) == 8 &&
              offsetof(ClBlock, kind) == 12 && offsetof(ClBlock, is_arc) == 15 &&
              offsetof(ClBlock, tip_mm) == 16 && offsetof(ClBlock, text) == 136);

std::uint32_t batch_crc(const Batch& batch) noexcept {
  std::array<std::byte, 21> head{};
  const std::uint8_t is_end = batch.is_end ? 1 : 0;
  std::memcpy(head.data(), &batch.session, 8);
  std::memcpy(head.data() + 8, &batch.first_sequence, 8);
  std::memcpy(head.data() + 16, &batch.count, 4);
  std::memcpy(head.data() + 20, &is_end, 1);
  const std::size_t used = std::min<std::size_t>(batch.count, kBatchBlocks);
  return crc32c(std::as_bytes(std::span(batch.blocks).first(used)), crc32c(head));
}

}  // namespace meridian::dds
