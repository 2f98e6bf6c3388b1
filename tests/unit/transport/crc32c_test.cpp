// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert/crc32c.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "service/transport/convert/messages.hpp"

namespace meridian::dds {
namespace {

std::uint32_t crc_of(std::string_view text) { return crc32c(std::as_bytes(std::span(text))); }

TEST(Crc32c, GivesThePublishedCheckValue) { EXPECT_EQ(crc_of("123456789"), 0xE3069283U); }

TEST(Crc32c, GivesTheVectorsOfRfc3720) {
  const std::vector<std::byte> zeros(32, std::byte{0});
  const std::vector<std::byte> ones(32, std::byte{0xFF});
  std::vector<std::byte> rising;
  for (int i = 0; i < 32; ++i) rising.push_back(static_cast<std::byte>(i));
  EXPECT_EQ(crc32c(zeros), 0x8A9136AAU);
  EXPECT_EQ(crc32c(ones), 0x62A8AB43U);
  EXPECT_EQ(crc32c(rising), 0x46DD794EU);
}

TEST(Crc32c, ContinuesFromASeedAtAnyCut) {
  const std::string_view text = "one table, four slices, any length";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    const auto bytes = std::as_bytes(std::span(text));
    EXPECT_EQ(crc32c(bytes.subspan(cut), crc32c(bytes.first(cut))), crc_of(text)) << cut;
  }
}

Batch sample_batch() {
  Batch batch;
  batch.session = 7;
  batch.first_sequence = 100;
  batch.count = 3;
  for (std::size_t i = 0; i < kBatchBlocks; ++i) batch.blocks[i].sequence = 100 + i;
  return batch;
}

TEST(BatchCrc, ChangesWithEveryBitOfHeadAndUsedBlocks) {
  const Batch good = sample_batch();
  const std::uint32_t crc = batch_crc(good);
  Batch bad = good;
  bad.session ^= 1U;
  EXPECT_NE(batch_crc(bad), crc);
  bad = good;
  bad.first_sequence ^= 1U << 31U;
  EXPECT_NE(batch_crc(bad), crc);
  bad = good;
  bad.count = 2;
  EXPECT_NE(batch_crc(bad), crc);
  bad = good;
  bad.is_end = true;
  EXPECT_NE(batch_crc(bad), crc);
  for (std::size_t byte = 0; byte < 3 * sizeof(ClBlock); ++byte) {
    if (byte % sizeof(ClBlock) == offsetof(ClBlock, is_arc)) continue;  // a bool holds 0 or 1
    for (int bit = 0; bit < 8; ++bit) {
      bad = good;
      reinterpret_cast<unsigned char*>(bad.blocks.data())[byte] ^=
          static_cast<unsigned char>(1U << bit);
      ASSERT_NE(batch_crc(bad), crc) << "byte " << byte << " bit " << bit;
    }
  }
}

TEST(BatchCrc, LeavesUnusedSlotsOut) {
  Batch batch = sample_batch();
  const std::uint32_t crc = batch_crc(batch);
  batch.blocks[3].line = 99;
  EXPECT_EQ(batch_crc(batch), crc);
}

TEST(BatchCrc, ReadsNoMoreThanTheArrayForAnAbsurdCount) {
  Batch batch = sample_batch();
  batch.count = 4'000'000'000U;
  EXPECT_NE(batch_crc(batch), batch_crc(sample_batch()));
}

}  // namespace
}  // namespace meridian::dds
