// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meridian::text {

/// A file of a tool's output that is there whole or as it was before: it is written beside its
/// place, as NAME.part, and put there by commit(). What is no regular file (a pipe, a terminal) is
/// written to at once and stays what it is. Proof: tests/unit/text/whole_file_test.cpp.
class WholeFile {
 public:
  explicit WholeFile(std::string name);
  /// Without a commit the part goes.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  [[nodiscard]] std::ostream& out() noexcept { return file_; }
  /// False where anything could not be written.
  [[nodiscard]] bool commit();

 private:
  std::string name_, written_;
  std::ofstream file_;
};

/// All bytes of the file `path`, or nothing where it cannot be opened.
/// Proof: tests/unit/text/whole_file_test.cpp.
[[nodiscard]] std::optional<std::string> read_whole(const std::filesystem::path& path);

/// All of `content` in a file of that name, or what was there before and false.
[[nodiscard]] bool write_whole(const std::string& name, const std::string& content);

/// Whether a file is to be on disk when it was written, or when the system comes to it.
enum class Sync { kLater, kNow };

/// All of `content` in a new file `path`: what lies there under that name goes, a link is not
/// followed. Its mode is `mode` less the umask. Returns 0, or the errno of what failed; then there
/// is no such file. Blocks as long as the disk does. Proof: tests/unit/text/whole_file_test.cpp.
[[nodiscard]] int write_anew(const std::filesystem::path& path, std::string_view content,
                             Sync sync = Sync::kLater, mode_t mode = 0666) noexcept;

/// Why a run that reads the files `read` may not write `written`: it would lose one of them. A
/// line that names it; empty: it may. Names that are empty name no file.
/// Proof: tests/unit/text/whole_file_test.cpp.
[[nodiscard]] std::string refusal_to_write(const std::vector<std::string>& read,
                                           const std::vector<std::string>& written);

}  // namespace meridian::text
