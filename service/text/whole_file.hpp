// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace meridian::text {

/// A file of a tool's output that is there whole or as it was before: it is written beside its
/// place, as NAME.part, and put there by commit(). What is no regular file (a pipe, a terminal) is
/// written to at once and stays what it is. Proof: tests/unit/cli/recording_commands_test.cpp.
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

/// All of `content` in a file of that name, or what was there before and false.
[[nodiscard]] bool write_whole(const std::string& name, const std::string& content);

/// Whether a file is to be on disk when it was written, or when the system comes to it.
enum class Sync { kLater, kNow };

/// All of `content` in a new file `path`: what lies there under that name goes, a link is not
/// followed. Its mode is `mode` less the umask. Returns 0, or the errno of what failed; then there
/// is no such file. Blocks as long as the disk does.
[[nodiscard]] int write_anew(const std::filesystem::path& path, std::string_view content,
                             Sync sync = Sync::kLater, mode_t mode = 0666) noexcept;

/// Whether both names are one file that is there.
[[nodiscard]] bool is_same_file(const std::string& a, const std::string& b);

}  // namespace meridian::text
