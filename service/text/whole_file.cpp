// SPDX-License-Identifier: Apache-2.0
#include "service/text/whole_file.hpp"

#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace meridian::text {

WholeFile::WholeFile(std::string name) : name_(std::move(name)) {
  std::error_code ignored;
  const auto is = std::filesystem::status(name_, ignored);
  const bool is_replaced = !std::filesystem::exists(is) || std::filesystem::is_regular_file(is);
  // Where the name is a link, the file that it leads to is replaced, not the link.
  if (is_replaced && std::filesystem::exists(is)) {
    name_ = std::filesystem::canonical(name_, ignored).string();
  }
  written_ = is_replaced ? name_ + ".part" : name_;
  file_.open(written_, std::ios::binary);
}

WholeFile::~WholeFile() {
  if (written_ != name_ && !written_.empty()) std::remove(written_.c_str());
}

bool WholeFile::commit() {
  const bool is_open = file_.is_open();
  file_.close();
  if (!is_open || !file_) return false;
  if (written_ == name_) return true;
  if (std::rename(written_.c_str(), name_.c_str()) != 0) return false;
  written_.clear();
  return true;
}

bool write_whole(const std::string& name, const std::string& content) {
  WholeFile file(name);
  file.out() << content;
  return file.commit();
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

}  // namespace meridian::text
