// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/journal.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <thread>
#include <utility>

namespace meridian::telemetry {
namespace {

/// No journal is longer; what is, is something else.
constexpr std::size_t kMost_bytes = 4096;

/// The machine's name as that of a file.
[[nodiscard]] std::string file_name_of(const std::string& machine) {
  std::string name = machine;
  for (char& c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    if (!is_plain) c = '_';
  }
  return name + ".journal";
}

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

[[nodiscard]] int sync_folder(const std::filesystem::path& folder) noexcept {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return errno;
  const int error = ::fsync(file) == 0 ? 0 : errno;
  (void)::close(file);
  return error;
}

}  // namespace

int replace_file(const std::filesystem::path& path, const std::string& text) {
  const std::string beside = path.string() + ".new";
  const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640);
  if (file < 0) return errno;
  int error = write_all(file, text);
  if (error == 0 && ::fsync(file) != 0) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  if (error != 0) return error;
  if (::rename(beside.c_str(), path.c_str()) != 0) return errno;
  return sync_folder(path.parent_path());
}

Journal::Journal(const std::filesystem::path& folder, std::string machine, Write write)
    : machine_(std::move(machine)), write_(std::move(write)) {
  if (folder.empty()) return;
  path_ = folder / file_name_of(machine_);
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    complaint_ = fmt::format(
        "the folder of the journal, {}, cannot be made: {}; the last executed "
        "block will not be known after a crash",
        folder.string(), failed.message());
  }
}

std::optional<JournalEntry> Journal::read() {
  if (path_.empty()) return std::nullopt;
  std::ifstream file(path_, std::ios::binary);
  if (!file) return std::nullopt;
  std::string text(kMost_bytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  auto entry = parse_journal(text, machine_);
  if (entry) return *entry;
  put_aside(entry.error());
  return std::nullopt;
}

void Journal::put_aside(const std::string& why) {
  const std::filesystem::path aside = path_.string() + ".refused";
  std::error_code failed;
  std::filesystem::rename(path_, aside, failed);
  complaint_ = fmt::format("{} {}; where the program stopped is not known{}", path_.string(), why,
                           failed ? "" : " (put aside as " + aside.filename().string() + ")");
}

void Journal::run(const std::function<void(const std::string&)>& complain) noexcept {
  if (path_.empty()) return;
  int told = 0;
  for (bool is_last = false; !is_last;) {
    is_last = is_stopping_.load();
    if (newest_.refresh()) {
      const int error = write_(path_, to_text(newest_.latest(), machine_));
      if (error != 0 && error != told) {
        complain(fmt::format("the journal {} cannot be written: {}", path_.string(),
                             std::strerror(error)));
      }
      told = error;
    }
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace meridian::telemetry
