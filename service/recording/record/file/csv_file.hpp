// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "service/recording/record/file/record_error.hpp"

namespace meridian::record {

/// Appends fields to a row, in a buffer that is known to have room.
class CsvRow {
 public:
  explicit CsvRow(char* at) noexcept : at_(at) {}
  [[nodiscard]] char* end() const noexcept { return at_; }

  CsvRow& put(char c) noexcept {
    *at_++ = c;
    return *this;
  }
  CsvRow& put(std::string_view text) noexcept {
    std::memcpy(at_, text.data(), text.size());
    at_ += text.size();
    return *this;
  }
  template <class Integer>
  CsvRow& put_integer(Integer value) noexcept {
    at_ = std::to_chars(at_, at_ + 24, value).ptr;
    return *this;
  }
  /// 17 significant digits: every double comes back as it was.
  CsvRow& put_real(double value) noexcept {
    at_ = std::to_chars(at_, at_ + 32, value, std::chars_format::general, 17).ptr;
    return *this;
  }

 private:
  char* at_;
};

/// Whether a symbolic link in place of a file leads to the file that is written.
enum class Links { kFollowed, kRefused };

/// A text file that is written row by row: rows gather in a buffer of fixed size that goes to the
/// file when it is full. After a failed write nothing is written any more. Context: I/O.
class CsvFile {
 public:
  /// Creates or empties the file.
  [[nodiscard]] static Expected<CsvFile, RecordError> create(const std::string& path,
                                                             Links links = Links::kFollowed);
  /// Creates it in place of what has that name; a link is not followed.
  [[nodiscard]] static Expected<CsvFile, RecordError> create_anew(const std::string& path);
  /// Writes what is buffered; a failure is lost here, so call close() where it matters.
  ~CsvFile();
  CsvFile(CsvFile&& other) noexcept;
  CsvFile& operator=(CsvFile&& other) noexcept;
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  static constexpr std::size_t kLongestRow = 2048;

  /// Where the next row of at most kLongestRow characters goes; nullptr once a write failed.
  [[nodiscard]] char* begin_row() noexcept;
  /// Takes the row that was put there up to `end`.
  void end_row(const char* end) noexcept;
  /// Adds text of any length.
  bool append(std::string_view text) noexcept;

  /// Hands what is buffered to the system.
  bool flush() noexcept;
  /// Flushes and closes; false where anything was lost.
  bool close() noexcept;

  [[nodiscard]] int error_number() const noexcept { return error_number_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  CsvFile(int file, std::string path);
  [[nodiscard]] static Expected<CsvFile, RecordError> open(const std::string& path, int how);

  std::string path_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
  int file_ = -1;
  int error_number_ = 0;
};

}  // namespace meridian::record
