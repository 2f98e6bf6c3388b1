// SPDX-License-Identifier: Apache-2.0
#include "service/recording/mcap/file_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace meridian::mcap {

int FileOutput::open(const std::string& path) noexcept {
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_TRUNC, 0644);
  return file_ < 0 ? errno : 0;
}

bool FileOutput::write(std::string_view bytes) noexcept {
  crc_.add(bytes);
  size_ += bytes.size();
  while (error_number_ == 0 && !bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (written == 0) {
      error_number_ = EIO;
    } else if (errno != EINTR) {
      error_number_ = errno;
    }
  }
  return error_number_ == 0;
}

bool FileOutput::close() noexcept {
  if (file_ < 0) return error_number_ == 0;
  if (::close(file_) != 0 && error_number_ == 0) error_number_ = errno;
  file_ = -1;
  return error_number_ == 0;
}

}  // namespace meridian::mcap
