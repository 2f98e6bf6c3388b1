// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <string>

namespace meridian::test {

/// The name of a file in the temporary folder that no other test has, in this process or beside it.
/// The file is removed at the end.
class Scratch {
 public:
  explicit Scratch(const std::string& ending) {
    static std::atomic<int> count{0};
    const std::string name =
        "meridian-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + ending;
    path_ = (std::filesystem::temp_directory_path() / name).string();
  }
  ~Scratch() { std::remove(path_.c_str()); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  std::string path_;
};

}  // namespace meridian::test
