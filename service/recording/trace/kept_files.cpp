// SPDX-License-Identifier: Apache-2.0
#include "service/recording/trace/kept_files.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <system_error>
#include <utility>

#include "service/text/whole_file.hpp"

namespace meridian::trace {
namespace {

[[nodiscard]] std::string time_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof text, "%Y%m%dT%H%M%SZ", &parts);
  return {text, length};
}

}  // namespace

std::vector<KeptFile> find_kept(const std::filesystem::path& folder) {
  std::vector<KeptFile> kept;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    long long severity_us = 0;
    if (entry.path().extension() != ".json") continue;
    if (std::sscanf(name.c_str(), "slow-%lldus-", &severity_us) != 1) continue;
    kept.push_back({severity_us, entry.path()});
  }
  std::sort(kept.begin(), kept.end(),
            [](const KeptFile& a, const KeptFile& b) { return a.severity_us > b.severity_us; });
  return kept;
}

KeptFiles::KeptFiles(std::filesystem::path folder, int max)
    : folder_(std::move(folder)), max_(static_cast<std::size_t>(std::max(max, 1))) {
  std::filesystem::create_directories(folder_);
  kept_ = find_kept(folder_);
}

bool KeptFiles::would_keep(std::int64_t severity_ns) const {
  return kept_.size() < max_ || severity_ns / 1000 > kept_[max_ - 1].severity_us;
}

std::filesystem::path KeptFiles::add(std::int64_t severity_ns, const std::string& content) {
  const std::int64_t severity_us = severity_ns / 1000;
  const std::string name = "slow-" + std::to_string(severity_us) + "us-" + time_now();
  const std::filesystem::path file = folder_ / (name + ".json"), part = folder_ / (name + ".part");
  std::error_code failed;
  if (text::write_anew(part, content) != 0) return {};
  std::filesystem::rename(part, file, failed);
  if (failed) return {};
  const auto position =
      std::find_if(kept_.begin(), kept_.end(),
                   [severity_us](const KeptFile& kept) { return kept.severity_us < severity_us; });
  kept_.insert(position, {severity_us, file});
  for (; kept_.size() > max_; kept_.pop_back()) {
    std::filesystem::remove(kept_.back().file, failed);
  }
  return file;
}

}  // namespace meridian::trace
