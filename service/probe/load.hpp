// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace meridian::probe {

/// Work that has nothing to do with real time, as long as it lives: a thread of normal priority on
/// every CPU that copies memory larger than the caches, and writes to a file and throws it away.
class Load {
 public:
  Load();
  ~Load();
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  std::atomic<bool> is_stopping_{false};
  std::vector<std::thread> threads_;
};

}  // namespace meridian::probe
