// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace meridian::trace {

/// A trace of a slow cycle on disk.
struct KeptFile {
  std::int64_t severity_us = 0;
  std::filesystem::path file;
};

/// Those in `folder`, the worst first. Throws std::filesystem::filesystem_error where it cannot be
/// read.
[[nodiscard]] std::vector<KeptFile> find_kept(const std::filesystem::path& folder);

/// The worst traces in a folder: at most so many, those of earlier services included. A file's
/// name, slow-SEVERITYus-TIME.json, says how bad its cycle was and when it was written (UTC).
/// Proof: tests/unit/daemon/trace_test.cpp.
class KeptFiles {
 public:
  /// Makes the folder where it is missing; throws std::filesystem::filesystem_error.
  KeptFiles(std::filesystem::path folder, int max);

  /// Whether a trace so bad would be kept.
  [[nodiscard]] bool would_keep(std::int64_t severity_ns) const;
  /// Writes it, whole or not at all, and removes the mildest ones where they are too many. Empty
  /// where it cannot be written.
  [[nodiscard]] std::filesystem::path add(std::int64_t severity_ns, const std::string& text);

 private:
  std::filesystem::path folder_;
  std::size_t max_;
  std::vector<KeptFile> kept_;  ///< the worst first
};

}  // namespace meridian::trace
