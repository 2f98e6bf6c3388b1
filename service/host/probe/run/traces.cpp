// SPDX-License-Identifier: Apache-2.0
#include <sys/statvfs.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

#include "service/host/probe/doctor/doctor.hpp"
#include "service/recording/trace/kept_files.hpp"

namespace meridian::probe {
namespace {

namespace fs = std::filesystem;

/// What ten traces take, of the fastest cycle and with room to spare.
constexpr std::uintmax_t kWanted_bytes = 16'000'000;

/// `folder`, or what the service would make it in.
[[nodiscard]] fs::path find_existing(fs::path folder) {
  std::error_code ignored;
  while (!folder.empty() && !fs::exists(folder, ignored)) folder = folder.parent_path();
  return folder;
}

/// Why nothing can be written below the folder `place`; empty: it can.
[[nodiscard]] std::string hindrance(const fs::path& directory) {
  std::error_code failed;
  if (!fs::is_directory(directory, failed)) return directory.string() + " is no folder";
  struct statvfs volume {};
  if (::statvfs(directory.c_str(), &volume) == 0 && (volume.f_flag & ST_RDONLY) != 0) {
    return directory.string() + " can only be read";
  }
  if (::access(directory.c_str(), W_OK | X_OK) != 0) {
    return "this user may not write into " + directory.string();
  }
  const fs::space_info space = fs::space(directory, failed);
  if (failed || space.available >= kWanted_bytes) return "";
  return directory.string() + " has " + std::to_string(space.available / 1'000'000) + " MB left";
}

[[nodiscard]] std::string report_kept(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return "the service makes " + folder.string();
  const auto kept = trace::find_kept(folder);
  if (kept.empty()) return "none in " + folder.string() + " so far";
  return std::to_string(kept.size()) + " in " + folder.string() + ", of the worst cycle " +
         kept.front().file.filename().string() +
         ": open it in https://ui.perfetto.dev or chrome://tracing";
}

}  // namespace

Findings examine_traces(const fs::path& folder) {
  const std::string what = "traces of slow cycles";
  if (folder.empty()) {
    return {{what, Health::kFine,
             "none unless asked for: meridiand --trace FOLDER (meridian doctor --trace FOLDER "
             "looks whether it can be written)",
             ""}};
  }
  std::error_code ignored;
  const std::string why_not = hindrance(find_existing(fs::absolute(folder, ignored)));
  if (!why_not.empty()) {
    return {{what, Health::kNote, "cannot be written to " + folder.string() + ": " + why_not,
             "name a folder on a local disk that the service's user may write; the machine runs "
             "without traces too"}};
  }
  try {
    return {{what, Health::kFine, report_kept(folder), ""}};
  } catch (const fs::filesystem_error& error) {
    return {{what, Health::kNote, error.what(), "let this user read the folder"}};
  }
}

}  // namespace meridian::probe
