// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace meridian::support {

/// A DDS domain that no other test of this host uses while it lives: domains are claimed by a file
/// lock each, from 100 to 220 (deploy/demo has 60 to 99), so that tests run in parallel without
/// seeing each other.
class PrivateDomain {
 public:
  PrivateDomain() {
    for (std::uint32_t i = 0; i <= 120; ++i) {
      id_ = 100 + (static_cast<std::uint32_t>(::getpid()) + i) % 121;
      const std::string path = "/tmp/meridian-test-domain-" + std::to_string(id_);
      file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
      if (file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
      if (file_ >= 0) ::close(file_);
    }
    throw std::runtime_error("every test domain is in use; wait for other test runs to end");
  }
  ~PrivateDomain() { ::close(file_); }
  PrivateDomain(const PrivateDomain&) = delete;
  PrivateDomain& operator=(const PrivateDomain&) = delete;

  [[nodiscard]] std::uint32_t id() const noexcept { return id_; }

 private:
  std::uint32_t id_ = 0;
  int file_ = -1;
};

}  // namespace meridian::support
