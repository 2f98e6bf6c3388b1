// SPDX-License-Identifier: Apache-2.0
#include "service/recording/mcap/summary.hpp"

#include <algorithm>

#include "service/recording/mcap/bytes.hpp"
#include "service/recording/mcap/crc32.hpp"

namespace meridian::mcap {

void Summary::add_schema(std::string_view record) {
  schemas_.append(record);
  ++schema_count_;
}

void Summary::add_channel(std::string_view record) {
  channels_.append(record);
  ++channel_count_;
}

void Summary::add_metadata(std::string_view name, std::uint64_t offset, std::uint64_t length) {
  ++metadata_count_;
  put_record(metadata_, Opcode::kMetadataIndex, [&](std::string& out) {
    put(out, offset);
    put(out, length);
    put_text(out, name);
  });
}

void Summary::add_message(std::uint16_t channel, std::uint64_t time_ns) {
  if (channel >= message_counts_.size()) message_counts_.resize(channel + std::size_t{1});
  ++message_counts_[channel];
  first_ns_ = message_count_ == 0 ? time_ns : std::min(first_ns_, time_ns);
  last_ns_ = message_count_ == 0 ? time_ns : std::max(last_ns_, time_ns);
  ++message_count_;
}

void Summary::add_chunk(const ChunkEntry& chunk) {
  ++chunk_count_;
  put_record(chunks_, Opcode::kChunkIndex, [&](std::string& out) {
    put(out, chunk.first_ns);
    put(out, chunk.last_ns);
    put(out, chunk.offset);
    put(out, chunk.length);
    put_list(out, [&](std::string& list) {
      for (std::size_t channel = 0; channel < chunk.index_offsets.size(); ++channel) {
        if (chunk.index_offsets[channel] == 0) continue;
        put(list, static_cast<std::uint16_t>(channel));
        put(list, chunk.index_offsets[channel]);
      }
    });
    put(out, chunk.index_length);
    put_text(out, chunk.compression);
    put(out, chunk.packed_size);
    put(out, chunk.plain_size);
  });
}

std::uint64_t Summary::message_count(std::uint16_t channel) const noexcept {
  return channel < message_counts_.size() ? message_counts_[channel] : 0;
}

std::string Summary::statistics() const {
  std::string record;
  put_record(record, Opcode::kStatistics, [&](std::string& out) {
    put(out, message_count_);
    put(out, schema_count_);
    put(out, std::uint32_t{channel_count_});
    put(out, std::uint32_t{0});  // attachments
    put(out, metadata_count_);
    put(out, chunk_count_);
    put(out, first_ns_);
    put(out, last_ns_);
    put_list(out, [&](std::string& list) {
      for (std::size_t channel = 0; channel < message_counts_.size(); ++channel) {
        if (message_counts_[channel] == 0) continue;
        put(list, static_cast<std::uint16_t>(channel));
        put(list, message_counts_[channel]);
      }
    });
  });
  return record;
}

std::string Summary::text(std::uint64_t offset) const {
  const std::string counts = statistics();
  struct Group {
    Opcode opcode;
    const std::string& records;
  };
  const Group groups[] = {{Opcode::kSchema, schemas_},
                          {Opcode::kChannel, channels_},
                          {Opcode::kStatistics, counts},
                          {Opcode::kChunkIndex, chunks_},
                          {Opcode::kMetadataIndex, metadata_}};
  std::string out, offsets;
  for (const Group& group : groups) {
    if (group.records.empty()) continue;
    put_record(offsets, Opcode::kSummaryOffset, [&](std::string& to) {
      put(to, static_cast<std::uint8_t>(group.opcode));
      put(to, offset + out.size());
      put(to, static_cast<std::uint64_t>(group.records.size()));
    });
    out += group.records;
  }
  const std::uint64_t offsets_begin = offset + out.size();
  out += offsets;
  put_head(out, Opcode::kFooter, 2 * sizeof(std::uint64_t) + sizeof(std::uint32_t));
  put(out, offset);
  put(out, offsets_begin);
  put(out, crc32_of(out));
  return out;
}

}  // namespace meridian::mcap
