// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace meridian::mcap {

enum class Compression : std::uint8_t { kNone, kZstd };

/// What the summary says of a chunk that was written.
struct ChunkEntry {
  std::uint64_t first_ns = 0, last_ns = 0;   ///< earliest and latest message
  std::uint64_t offset = 0, length = 0;      ///< of the chunk's record in the file
  std::vector<std::uint64_t> index_offsets;  ///< by channel; 0: it has no message there
  std::uint64_t index_length = 0;            ///< of all message indexes after the chunk
  std::uint64_t packed_size = 0, plain_size = 0;
  std::string_view compression;
};

/// Messages that are packed together, and where each of them stands. It is used over and over, so
/// its memory stays what the fullest one took. Proof: tests/unit/mcap/writer_test.cpp.
class Chunk {
 public:
  explicit Chunk(Compression compression);
  ~Chunk();
  Chunk(const Chunk&) = delete;
  Chunk& operator=(const Chunk&) = delete;

  void add(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
           std::string_view data);
  [[nodiscard]] bool is_empty() const noexcept { return records_.empty(); }
  /// Bytes of its messages before they are packed.
  [[nodiscard]] std::size_t size() const noexcept { return records_.size(); }

  /// Replaces `out` by the chunk's record with the indexes of its messages, as they stand from
  /// `offset` of the file on, and begins the next chunk.
  void finish(std::uint64_t offset, std::string& out, ChunkEntry& entry);

 private:
  struct IndexEntry {
    std::uint64_t time_ns = 0, offset = 0;
  };
  struct Packer;
  [[nodiscard]] std::string_view pack();

  std::unique_ptr<Packer> packer_;  ///< null: nothing is packed
  std::string records_, packed_;
  std::vector<std::vector<IndexEntry>> index_;  ///< by channel
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
};

}  // namespace meridian::mcap
