// SPDX-License-Identifier: Apache-2.0
#include "service/recording/mcap/chunk.hpp"

#include <zstd.h>

#include <algorithm>

#include "service/recording/mcap/bytes.hpp"
#include "service/recording/mcap/crc32.hpp"

namespace meridian::mcap {
namespace {

/// The fastest: of numbers that are mostly noise the levels up to 12 save 2 % at most.
constexpr int kLevel = 1;

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const noexcept { (void)ZSTD_freeCCtx(context); }
};

}  // namespace

struct Chunk::Packer {
  std::unique_ptr<ZSTD_CCtx, FreeContext> context{ZSTD_createCCtx()};
};

Chunk::Chunk(Compression compression) {
  if (compression == Compression::kZstd) packer_ = std::make_unique<Packer>();
}

Chunk::~Chunk() = default;

void Chunk::add(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                std::string_view data) {
  if (channel >= index_.size()) index_.resize(channel + std::size_t{1});
  index_[channel].push_back({time_ns, records_.size()});
  first_ns_ = is_empty() ? time_ns : std::min(first_ns_, time_ns);
  last_ns_ = is_empty() ? time_ns : std::max(last_ns_, time_ns);
  put_record(records_, Opcode::kMessage, [&](std::string& out) {
    put(out, channel);
    put(out, sequence);
    put(out, time_ns);  // when it was logged
    put(out, time_ns);  // and when it was published
    out.append(data);
  });
}

/// Packs the records; empty where they stay as they are.
std::string_view Chunk::pack() {
  if (packer_ == nullptr || packer_->context == nullptr) return {};
  packed_.resize(ZSTD_compressBound(records_.size()));
  const std::size_t length =
      ZSTD_compressCCtx(packer_->context.get(), packed_.data(), packed_.size(), records_.data(),
                        records_.size(), kLevel);
  if (ZSTD_isError(length) != 0U) return {};
  return std::string_view(packed_).substr(0, length);
}

void Chunk::finish(std::uint64_t offset, std::string& out, ChunkEntry& entry) {
  const std::string_view packed = pack();
  const std::string_view content = packed.empty() ? std::string_view(records_) : packed;
  entry.first_ns = first_ns_;
  entry.last_ns = last_ns_;
  entry.offset = offset;
  entry.packed_size = content.size();
  entry.plain_size = records_.size();
  entry.compression = packed.empty() ? "" : "zstd";
  out.clear();
  put_record(out, Opcode::kChunk, [&](std::string& to) {
    put(to, first_ns_);
    put(to, last_ns_);
    put(to, static_cast<std::uint64_t>(records_.size()));
    put(to, crc32_of(records_));
    put_text(to, entry.compression);
    put(to, static_cast<std::uint64_t>(content.size()));
    to.append(content);
  });
  entry.length = out.size();
  entry.index_offsets.assign(index_.size(), 0);
  for (std::size_t channel = 0; channel < index_.size(); ++channel) {
    if (index_[channel].empty()) continue;
    entry.index_offsets[channel] = offset + out.size();
    put_record(out, Opcode::kMessageIndex, [&](std::string& to) {
      put(to, static_cast<std::uint16_t>(channel));
      put_list(to, [&](std::string& list) {
        for (const IndexEntry& message : index_[channel]) {
          put(list, message.time_ns);
          put(list, message.offset);
        }
      });
    });
    index_[channel].clear();
  }
  entry.index_length = out.size() - entry.length;
  records_.clear();
}

}  // namespace meridian::mcap
