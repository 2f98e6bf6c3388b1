// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace meridian::process {

/// Those that probe and soak choose from where they are given none.
inline constexpr std::uint32_t kFirstProbeDomain = 221, kLastProbeDomain = 230;

/// A DDS domain that no other test, probe or soak of this host uses while it lives, so that they
/// run side by side without seeing each other: each is claimed by a file lock. Services and
/// stations take whatever domain they are given and claim none.
class ClaimedDomain {
 public:
  /// One of `first` to `last`; throws std::runtime_error where all are taken.
  ClaimedDomain(std::uint32_t first, std::uint32_t last) {
    const std::uint32_t count = last - first + 1;
    for (std::uint32_t i = 0; i < count; ++i) {
      id_ = first + (static_cast<std::uint32_t>(::getpid()) + i) % count;
      file_ = open_file("/tmp/meridian-test-domain-" + std::to_string(id_));
      if (file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
      if (file_ >= 0) ::close(file_);
    }
    throw std::runtime_error("DDS domains " + std::to_string(first) + " to " +
                             std::to_string(last) + " are all in use by tests, probes or soaks");
  }
  ~ClaimedDomain() { ::close(file_); }
  ClaimedDomain(const ClaimedDomain&) = delete;
  ClaimedDomain& operator=(const ClaimedDomain&) = delete;

  [[nodiscard]] std::uint32_t id() const noexcept { return id_; }

 private:
  /// Another user's file will do: a lock asks for no right to write.
  [[nodiscard]] static int open_file(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    return file >= 0 ? file : ::open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0644);
  }

  std::uint32_t id_ = 0;
  int file_ = -1;
};

}  // namespace meridian::process
