// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace meridian::test {

[[nodiscard]] inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A file in the temporary folder that goes away with this object.
class TextFile {
 public:
  explicit TextFile(std::string_view text, std::string_view ending = ".toml") {
    static std::atomic<int> count{0};
    path_ =
        std::filesystem::temp_directory_path() / ("meridian-" + std::to_string(::getpid()) + "-" +
                                                  std::to_string(count++) + std::string(ending));
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TextFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace meridian::test
