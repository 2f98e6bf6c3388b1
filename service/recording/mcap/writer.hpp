// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "meridian/expected.hpp"
#include "service/recording/mcap/chunk.hpp"
#include "service/recording/mcap/file_output.hpp"
#include "service/recording/mcap/summary.hpp"

namespace meridian::mcap {

struct WriterSettings {
  std::string profile{};  ///< what kind of messages there are, "ros2" for one
  std::string library{};  ///< who writes
  Compression compression = Compression::kZstd;
  std::size_t chunk_bytes = 1U << 20U;  ///< messages that are packed together, before packing
};

/// Writes an MCAP file (mcap.dev/spec) as its messages come: header, schemas and channels, chunks
/// with the index of their messages, a summary at the end, with every checksum that the format has.
///
/// Memory: one chunk, packed and not, and some 100 bytes of every chunk before it. A full disk ends
/// the file and nothing else. Where close() is not come to (the process is killed) every chunk that
/// was ended is in the file, which lacks its summary: readers go through it from the begin.
/// Context: I/O; one thread. Proof: tests/unit/mcap/writer_test.cpp.
class Writer {
 public:
  /// Creates or empties the file; errno where that fails.
  [[nodiscard]] static Expected<std::unique_ptr<Writer>, int> create(
      const std::string& path, const WriterSettings& settings);
  /// What it cannot write is lost, so call close() where it matters.
  ~Writer() { (void)close(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Returns the number that channels refer to it by.
  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view text);
  /// Returns the number that messages refer to it by.
  std::uint16_t add_channel(std::uint16_t schema, std::string_view topic,
                            std::string_view message_encoding);
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& values);

  /// Adds a message. False once a write failed (errno in error_number()); it is dropped then.
  bool write(std::uint16_t channel, std::uint64_t time_ns, std::string_view data);
  /// Hands the messages that wait for their chunk to be full to the system.
  bool end_chunk();
  /// Ends the file; false where anything was lost.
  bool close();

  [[nodiscard]] int error_number() const noexcept { return file_.error_number(); }
  /// Bytes of the file so far.
  [[nodiscard]] std::uint64_t size() const noexcept { return file_.size(); }

 private:
  explicit Writer(const WriterSettings& settings)
      : chunk_(settings.compression), chunk_bytes_(settings.chunk_bytes) {}

  FileOutput file_;
  Chunk chunk_;
  Summary summary_;
  ChunkEntry entry_;
  std::size_t chunk_bytes_;
  std::string record_;  ///< that is being made
  bool is_closed_ = false;
};

}  // namespace meridian::mcap
