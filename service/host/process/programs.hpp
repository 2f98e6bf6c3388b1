// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace meridian::process {

/// Path of `name` in the folder of the program that is running; throws std::runtime_error where
/// there is none. So a build tree uses its own programs and an installation its own.
[[nodiscard]] std::filesystem::path program_beside(const std::string& name);

/// A file that Meridian ships, "budgets.toml" or "machines/lai.toml": in share/meridian/ or deploy/
/// of the nearest folder above the running program that has it, or in the folder that the
/// environment variable MERIDIAN_SHARE names; throws std::runtime_error.
[[nodiscard]] std::filesystem::path shipped_file(const std::string& name);

/// A folder of its own in the system's place for temporary files, gone with this object.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace meridian::process
