// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "service/host/process/child_process.hpp"

namespace meridian::probe {

/// Work that has nothing to do with real time, as long as it lives: on every CPU that this process
/// was given a process of its own and of normal priority (burn()), so that it shares neither memory
/// nor allocator nor locks with what is measured. Each is the tool `meridian` beside the running
/// program. Proof: tests/unit/probe/load_test.cpp.
class Load {
 public:
  /// Returns when all of them work; throws std::runtime_error where one does not start.
  Load();

  [[nodiscard]] std::size_t count() const noexcept { return burners_.size(); }
  [[nodiscard]] pid_t id(std::size_t i) const { return burners_[i]->id(); }

 private:
  std::vector<std::unique_ptr<process::ChildProcess>> burners_;
};

/// The body of such a process: says "burning", then copies memory larger than the caches, and
/// writes to a file and throws it away, until it is killed.
[[noreturn]] void burn(int cpu);

}  // namespace meridian::probe
