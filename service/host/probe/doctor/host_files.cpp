// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/doctor/host_files.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>

namespace meridian::probe {

std::optional<std::string> HostFiles::text(const std::string& path) const {
  std::ifstream in(root_ / path, std::ios::binary);
  if (!in) return std::nullopt;
  std::string all{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) return std::nullopt;
  all.erase(all.find_last_not_of(" \n\t") + 1);
  return all;
}

std::optional<long long> HostFiles::number(const std::string& path) const {
  const auto all = text(path);
  long long value = 0;
  if (!all) return std::nullopt;
  const auto [end, error] = std::from_chars(all->data(), all->data() + all->size(), value);
  return error == std::errc() && end != all->data() ? std::optional(value) : std::nullopt;
}

std::vector<std::string> HostFiles::names(const std::string& folder,
                                          const std::string& prefix) const {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(root_ / folder, ignored)) {
    std::string name = entry.path().filename();
    if (name.starts_with(prefix)) out.push_back(std::move(name));
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<std::string> HostFiles::boot_option(const std::string& key) const {
  std::istringstream words(text("proc/cmdline").value_or(""));
  std::optional<std::string> value;
  for (std::string word; words >> word;) {
    if (word.starts_with(key + "=")) value = word.substr(key.size() + 1);
  }
  return value;
}

}  // namespace meridian::probe
