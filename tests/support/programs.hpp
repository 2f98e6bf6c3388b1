// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "meridian/path/cl_block.hpp"
#include "service/transport/convert/messages.hpp"

/// Blocks and batches for tests of the session protocol.
namespace meridian::test {

/// A cut in reach of lai_machine(): x goes to and fro with the sequence, axis tilted by 0.1 rad.
[[nodiscard]] inline ClBlock good_cut(std::uint64_t sequence) {
  ClBlock block;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence) + 10;
  block.kind = BlockKind::kCut;
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = 20;
  block.tip_mm = {static_cast<double>(sequence % 100), 0, 0};
  block.axis = {std::sin(0.1), 0, std::cos(0.1)};
  return block;
}

/// `count` good cuts from `first` on, CRC included.
[[nodiscard]] inline dds::Batch good_batch(std::uint64_t session, std::uint64_t first,
                                           std::uint32_t count, bool is_end = false) {
  dds::Batch batch;
  batch.session = session;
  batch.first_sequence = first;
  batch.count = count;
  batch.is_end = is_end;
  for (std::uint32_t i = 0; i < count; ++i) batch.blocks[i] = good_cut(first + i);
  batch.crc = dds::batch_crc(batch);
  return batch;
}

}  // namespace meridian::test
