// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "service/recording/mcap/chunk.hpp"

namespace meridian::mcap {

/// What stands at the end of an MCAP file, so that a reader needs to see nothing else of it to find
/// every message: schemas and channels once more, how many messages there are, where every chunk
/// is. It grows by some 100 bytes a chunk. Proof: tests/unit/mcap/writer_test.cpp.
class Summary {
 public:
  /// Records as they stand in front of the messages.
  void add_schema(std::string_view record);
  void add_channel(std::string_view record);
  /// The record of metadata `name` takes `length` bytes from `offset` of the file on.
  void add_metadata(std::string_view name, std::uint64_t offset, std::uint64_t length);
  void add_message(std::uint16_t channel, std::uint64_t time_ns);
  void add_chunk(const ChunkEntry& chunk);

  [[nodiscard]] std::uint16_t schema_count() const noexcept { return schema_count_; }
  [[nodiscard]] std::uint16_t channel_count() const noexcept { return channel_count_; }
  /// Messages of the channel, which are numbered from 0.
  [[nodiscard]] std::uint64_t message_count(std::uint16_t channel) const noexcept;

  /// The summary, from `offset` of the file on, with the footer behind it.
  [[nodiscard]] std::string text(std::uint64_t offset) const;

 private:
  [[nodiscard]] std::string statistics() const;

  std::string schemas_, channels_, metadata_, chunks_;
  std::uint16_t schema_count_ = 0, channel_count_ = 0;
  std::uint32_t metadata_count_ = 0, chunk_count_ = 0;
  std::uint64_t message_count_ = 0, first_ns_ = 0, last_ns_ = 0;
  std::vector<std::uint64_t> message_counts_;  ///< by channel
};

}  // namespace meridian::mcap
