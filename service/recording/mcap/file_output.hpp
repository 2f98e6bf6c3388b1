// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "service/recording/mcap/crc32.hpp"

namespace meridian::mcap {

/// A file that is written from its begin to its end, with the sum over what went into it. After a
/// failed write nothing is written any more. Context: I/O; one thread.
class FileOutput {
 public:
  FileOutput() = default;
  ~FileOutput() { (void)close(); }
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;

  /// Creates or empties the file. Returns 0 or errno.
  [[nodiscard]] int open(const std::string& path) noexcept;
  bool write(std::string_view bytes) noexcept;
  /// False where anything was lost.
  bool close() noexcept;

  /// Bytes that were given to write() since the begin.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  [[nodiscard]] std::uint32_t crc() const noexcept { return crc_.sum(); }
  [[nodiscard]] int error_number() const noexcept { return error_number_; }

 private:
  Crc32 crc_;
  std::uint64_t size_ = 0;
  int file_ = -1;
  int error_number_ = 0;
};

}  // namespace meridian::mcap
