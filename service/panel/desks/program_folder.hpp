// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"

namespace meridian::panel {

/// The folder of the panel that programs from pages are written to, one at a time. Nothing is ever
/// written outside of it: of a file's name only plain characters of its last part are kept, no
/// link is followed. The folder is a temporary one of this process, and goes with it.
/// One thread at a time. Proof: tests/panel/program_folder_test.cpp.
class ProgramFolder {
 public:
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20U;

  /// Fills a buffer, as read(2) does: 0 at the end, below 0 where it failed.
  using ReadBytes = std::function<std::int64_t(char* buffer, std::size_t size)>;

  /// A program that lies in the folder.
  struct Program {
    std::string name;  ///< as it is shown
    std::uint64_t bytes = 0;
    std::uint64_t lines = 0;
    std::vector<std::uint64_t> marks;  ///< where every kLinesPerMark-th line begins
  };

  /// Throws std::filesystem::filesystem_error.
  ProgramFolder();
  ~ProgramFolder();
  ProgramFolder(const ProgramFolder&) = delete;
  ProgramFolder& operator=(const ProgramFolder&) = delete;

  /// Writes the `bytes` bytes that `read` gives into the folder, beside the program that is there.
  /// The error is a sentence.
  [[nodiscard]] Expected<Program, std::string> receive(std::string_view name, std::uint64_t bytes,
                                                       const ReadBytes& read) const;
  /// What was received takes the place of the program that was there.
  void adopt(const Program& program);

  /// The file of the program that was adopted last; empty: none.
  [[nodiscard]] std::string file() const;
  /// `count` lines of it from line `first` (1 is the first) on.
  [[nodiscard]] std::string read_lines(const Program& program, std::uint64_t first,
                                       std::uint64_t count) const;

  /// `name` as a plain file name: letters, digits, dot, dash and underscore, at most 80 of them.
  [[nodiscard]] static std::string plain_name(std::string_view name);

 private:
  static constexpr std::uint64_t kLinesPerMark = 256;
  std::filesystem::path folder_;
  std::string name_;
};

}  // namespace meridian::panel
