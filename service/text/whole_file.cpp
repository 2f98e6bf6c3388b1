// SPDX-License-Identifier: Apache-2.0
#include "service/text/whole_file.hpp"

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <sstream>
#include <system_error>
#include <utility>

namespace meridian::text {
namespace {

/// Writes all of `text`; 0 or errno.
[[nodiscard]] int write_all(int file, std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t count = ::write(file, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count < 0 ? errno : EIO;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

[[nodiscard]] bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

/// Whether what is written to `b` replaces what is written to `a`. A pipe or a terminal takes both.
[[nodiscard]] bool is_same_output(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (a.empty() || b.empty()) return false;
  if (std::filesystem::exists(a, ignored)) {
    return std::filesystem::is_regular_file(a, ignored) && is_same_file(a, b);
  }
  const auto resolved = [&ignored](const std::string& name) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(name, ignored), ignored);
  };
  return resolved(a) == resolved(b);
}

}  // namespace

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

std::optional<std::string> read_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool write_whole(const std::string& name, const std::string& content) {
  WholeFile file(name);
  file.out() << content;
  return file.commit();
}

int write_anew(const std::filesystem::path& path, std::string_view content, Sync sync,
               mode_t mode) noexcept {
  (void)::unlink(path.c_str());
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (file < 0) return errno;
  int error = write_all(file, content);
  if (error == 0 && sync == Sync::kNow && ::fsync(file) != 0) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  if (error != 0) (void)::unlink(path.c_str());
  return error;
}

std::string refusal_to_write(const std::vector<std::string>& read,
                             const std::vector<std::string>& written) {
  for (auto one = written.begin(); one != written.end(); ++one) {
    const auto is_read = [one](const std::string& other) { return is_same_file(*one, other); };
    const auto is_twice = [one](const std::string& other) { return is_same_output(*one, other); };
    if (std::any_of(read.begin(), read.end(), is_read)) {
      return *one + ": is read by this run; name another file to write";
    }
    if (std::any_of(written.begin(), one, is_twice)) {
      return *one + ": is written twice by this run; name another file to write";
    }
  }
  return "";
}

}  // namespace meridian::text
