// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/csv_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace meridian::record {
namespace {

constexpr std::size_t kBufferBytes = 256 * 1024;

}  // namespace

Expected<CsvFile, RecordError> CsvFile::create(const std::string& path, Links links) {
  return open(path, links == Links::kRefused ? O_TRUNC | O_NOFOLLOW : O_TRUNC);
}

Expected<CsvFile, RecordError> CsvFile::create_anew(const std::string& path) {
  (void)::unlink(path.c_str());
  return open(path, O_EXCL | O_NOFOLLOW);
}

Expected<CsvFile, RecordError> CsvFile::open(const std::string& path, int how) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | how, 0644);
  if (file < 0 && errno == ELOOP && (how & O_NOFOLLOW) != 0) {
    return tl::make_unexpected(RecordError{path, 0, "is a symbolic link, which is not followed",
                                           "name a regular file, or remove the link"});
  }
  if (file < 0) {
    return tl::make_unexpected(
        RecordError{path, 0, std::string("cannot be created: ") + std::strerror(errno),
                    "name a file in a folder that exists and is writable"});
  }
  return CsvFile(file, path);
}

CsvFile::CsvFile(int file, std::string path)
    : path_(std::move(path)), buffer_(kBufferBytes), file_(file) {}

CsvFile::CsvFile(CsvFile&& other) noexcept
    : path_(std::move(other.path_)),
      buffer_(std::move(other.buffer_)),
      used_(std::exchange(other.used_, 0)),
      file_(std::exchange(other.file_, -1)),
      error_number_(other.error_number_) {}

CsvFile& CsvFile::operator=(CsvFile&& other) noexcept {
  if (this != &other) {
    close();
    path_ = std::move(other.path_);
    buffer_ = std::move(other.buffer_);
    used_ = std::exchange(other.used_, 0);
    file_ = std::exchange(other.file_, -1);
    error_number_ = other.error_number_;
  }
  return *this;
}

CsvFile::~CsvFile() { close(); }

char* CsvFile::begin_row() noexcept {
  if (file_ < 0 || error_number_ != 0) return nullptr;
  if (used_ + kLongestRow > buffer_.size() && !flush()) return nullptr;
  return buffer_.data() + used_;
}

void CsvFile::end_row(const char* end) noexcept {
  used_ = static_cast<std::size_t>(end - buffer_.data());
}

bool CsvFile::append(std::string_view text) noexcept {
  while (!text.empty()) {
    char* const at = begin_row();
    if (at == nullptr) return false;
    const std::size_t part = std::min(text.size(), kLongestRow);
    end_row(CsvRow(at).put(text.substr(0, part)).end());
    text.remove_prefix(part);
  }
  return true;
}

bool CsvFile::flush() noexcept {
  std::size_t done = 0;
  while (error_number_ == 0 && done < used_) {
    const ssize_t written = ::write(file_, buffer_.data() + done, used_ - done);
    if (written > 0) {
      done += static_cast<std::size_t>(written);
    } else if (written == 0) {
      error_number_ = EIO;
    } else if (errno != EINTR) {
      error_number_ = errno;
    }
  }
  used_ = 0;
  return error_number_ == 0;
}

bool CsvFile::close() noexcept {
  if (file_ < 0) return error_number_ == 0;
  flush();
  if (::close(file_) != 0 && error_number_ == 0) error_number_ = errno;
  file_ = -1;
  return error_number_ == 0;
}

}  // namespace meridian::record
