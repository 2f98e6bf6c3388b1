// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/watch/evidence.hpp"

#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace meridian::soak {
namespace {

namespace fs = std::filesystem;

/// Whether `file` is called `name`, a number, and an ending.
[[nodiscard]] bool is_kept(const std::string& file, const std::string& name) {
  if (!file.starts_with(name)) return false;
  const std::size_t stop = file.find_first_not_of("0123456789", name.size());
  return stop != std::string::npos && stop > name.size() && file[stop] == '.';
}

}  // namespace

Evidence::Evidence(fs::path folder, std::string name, int max)
    : folder_(std::move(folder)), name_(std::move(name)), max_(max) {
  std::vector<fs::path> old;
  std::error_code error;
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    if (is_kept(at->path().filename(), name_)) old.push_back(at->path());
  }
  for (const fs::path& file : old) fs::remove(file, error);
}

std::string Evidence::keep(std::initializer_list<Piece> pieces) {
  if (folder_.empty() || count_ >= max_) return "";
  const fs::path stem = folder_ / (name_ + std::to_string(++count_));
  std::error_code failed;
  fs::create_directories(folder_, failed);
  bool is_any = false;
  for (const Piece& piece : pieces) {
    is_any |= fs::copy_file(piece.file, stem.string() + piece.ending,
                            fs::copy_options::overwrite_existing, failed);
  }
  return is_any ? stem.string() : "";
}

}  // namespace meridian::soak
