// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/program_folder.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

namespace meridian::panel {
namespace {

namespace fs = std::filesystem;

/// Where a program is written until it is whole. A plain name has no dot in front.
constexpr const char* kIncoming = ".incoming";

[[nodiscard]] fs::path new_folder() {
  std::string pattern = (fs::temp_directory_path() / "meridian-panel-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    throw fs::filesystem_error("no folder for programs", pattern,
                               std::error_code(errno, std::generic_category()));
  }
  return pattern;
}

/// An open file that is closed with its scope.
class Descriptor {
 public:
  explicit Descriptor(const fs::path& path)
      : number_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0600)) {
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(number_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

 private:
  int number_;
};

[[nodiscard]] auto failed(const char* reason) { return tl::make_unexpected(std::string(reason)); }

}  // namespace

ProgramFolder::ProgramFolder() : folder_(new_folder()) {}

ProgramFolder::~ProgramFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string ProgramFolder::plain_name(std::string_view name) {
  constexpr std::size_t kMaxLength = 80;
  const std::size_t slash = name.find_last_of("/\\");
  if (slash != std::string_view::npos) name.remove_prefix(slash + 1);
  std::string out;
  for (const char c : name) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool is_plain = is_letter || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
    out += is_plain ? c : '_';
  }
  out.erase(0, std::min(out.find_first_not_of('.'), out.size()));
  if (out.size() > kMaxLength) out.erase(0, out.size() - kMaxLength);  // the ending stays
  return out.empty() ? "program" : out;
}

Expected<ProgramFolder::Program, std::string> ProgramFolder::receive(std::string_view name,
                                                                     std::uint64_t bytes,
                                                                     const ReadBytes& read) const {
  if (bytes == 0) return failed("the file is empty");
  if (bytes > kMaxBytes) {
    return failed("the file has more than 64 MiB; stream it with `meridian stream`");
  }
  const Descriptor file(folder_ / kIncoming);
  Program program{.name = plain_name(name), .bytes = 0, .lines = 1, .marks = {0}};
  std::array<char, 65'536> buffer;
  while (program.bytes < bytes) {
    const std::uint64_t left = std::min<std::uint64_t>(bytes - program.bytes, buffer.size());
    const std::int64_t got = read(buffer.data(), static_cast<std::size_t>(left));
    if (got <= 0) return failed("the file did not come whole; drop it again");
    const auto count = static_cast<std::uint64_t>(got);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (buffer[i] != '\n') continue;
      if (program.lines % kLinesPerMark == 0) program.marks.push_back(program.bytes + i + 1);
      ++program.lines;
    }
    if (!file.write({buffer.data(), static_cast<std::size_t>(count)})) {
      return failed("the panel's folder cannot be written: is the disk full?");
    }
    program.bytes += count;
  }
  return program;
}

void ProgramFolder::adopt(const Program& program) {
  std::error_code ignored;
  if (!name_.empty()) fs::remove(folder_ / name_, ignored);
  name_ = program.name;
  fs::rename(folder_ / kIncoming, folder_ / name_);
}

std::string ProgramFolder::file() const { return name_.empty() ? "" : (folder_ / name_).string(); }

std::string ProgramFolder::read_lines(const Program& program, std::uint64_t first,
                                      std::uint64_t count) const {
  constexpr std::uint64_t kMaxLines = 500;
  constexpr std::size_t kMaxLength = 400;
  if (first < 1 || first > program.lines) return "";
  const std::uint64_t mark = (first - 1) / kLinesPerMark;
  std::ifstream input(folder_ / program.name, std::ios::binary);
  input.seekg(static_cast<std::streamoff>(program.marks[mark]));
  std::string out, line;
  std::uint64_t number = mark * kLinesPerMark + 1;
  const std::uint64_t end = first + std::min(count, kMaxLines);
  for (; number < end && std::getline(input, line); ++number) {
    if (number < first) continue;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    out += line.substr(0, kMaxLength) + '\n';
  }
  return out;
}

}  // namespace meridian::panel
