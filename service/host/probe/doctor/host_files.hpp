// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace meridian::probe {

/// What the kernel reports of a host in /proc and /sys; tests put another folder in place of /.
class HostFiles {
 public:
  explicit HostFiles(std::filesystem::path root = "/") : root_(std::move(root)) {}

  /// All of a file without the blanks at its end; nothing where it cannot be read.
  [[nodiscard]] std::optional<std::string> text(const std::string& path) const;
  [[nodiscard]] std::optional<long long> number(const std::string& path) const;
  /// Names in `folder` that begin with `prefix`, sorted.
  [[nodiscard]] std::vector<std::string> names(const std::string& folder,
                                               const std::string& prefix) const;
  /// The last value of KEY= on the kernel's command line; nothing where there is none.
  [[nodiscard]] std::optional<std::string> boot_option(const std::string& key) const;

 private:
  std::filesystem::path root_;
};

}  // namespace meridian::probe
