// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "support/scratch.hpp"

namespace meridian::test {

[[nodiscard]] inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A file in the temporary folder that goes away with this object.
class TextFile {
 public:
  explicit TextFile(std::string_view text, std::string_view ending = ".toml")
      : scratch_(std::string(ending)), path_(scratch_.path()) {
    std::ofstream(path_, std::ios::binary) << text;
  }

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  Scratch scratch_;
  std::filesystem::path path_;
};

}  // namespace meridian::test
