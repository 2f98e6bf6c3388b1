// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/journal.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "service/recording/telemetry/file_name.hpp"
#include "service/recording/telemetry/journal/sealed_text.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::telemetry {
namespace {

/// No journal is longer; what is, is something else.
constexpr std::size_t kMax_bytes = 4096;
/// Stations and programs are named in it: it is not everybody's.
constexpr mode_t kMode = 0640;

[[nodiscard]] std::string position_name(const std::filesystem::path& journal) {
  return std::filesystem::path(journal).replace_extension(".position").string();
}

/// Brings the entry up to date by the positions that were written behind it.
void read_positions(const std::string& name, JournalEntry& entry) {
  const int file = ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
  if (file < 0) return;
  std::array<char, 2 * kPositionBytes> text{};
  const ssize_t count = ::pread(file, text.data(), text.size(), 0);
  (void)::close(file);
  for (const std::size_t at : {std::size_t{0}, kPositionBytes}) {
    if (count < static_cast<ssize_t>(at + kPositionBytes)) return;
    read_position({text.data() + at, kPositionBytes}, entry);
  }
}

[[nodiscard]] int sync_folder(const std::filesystem::path& folder) noexcept {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return errno;
  const int error = ::fsync(file) == 0 ? 0 : errno;
  (void)::close(file);
  return error;
}

}  // namespace

int replace_file(const std::filesystem::path& path, const std::string& content) {
  const std::string beside = path.string() + ".new";
  const int error = text::write_anew(beside, content, text::Sync::kNow, kMode);
  if (error != 0) return error;
  if (::rename(beside.c_str(), path.c_str()) != 0) return errno;
  return sync_folder(path.parent_path());
}

Journal::Journal(const std::filesystem::path& folder, std::string machine, Write write)
    : machine_(std::move(machine)), write_(std::move(write)) {
  if (folder.empty()) return;
  path_ = folder / (plain_name(machine_) + ".journal");
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    complaint_ = fmt::format(
        "the folder of the journal, {}, cannot be made: {}; the last executed "
        "block will not be known after a crash",
        folder.string(), failed.message());
  }
}

Journal::~Journal() {
  if (position_file_ >= 0) (void)::close(position_file_);
}

/// What is there under that name and no regular file is left alone: then no position is kept.
void Journal::write_position() noexcept {
  if (position_file_ < 0) {
    constexpr int kFlags = O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
    position_file_ = ::open(position_name(path_).c_str(), kFlags, kMode);
    struct stat facts {};
    const bool is_file =
        position_file_ >= 0 && ::fstat(position_file_, &facts) == 0 && S_ISREG(facts.st_mode);
    if (!is_file && position_file_ >= 0) (void)::close(std::exchange(position_file_, -1));
    if (!is_file) return;
  }
  const std::string text = to_position(position_.latest());
  const off_t at = is_second_ ? 0 : static_cast<off_t>(kPositionBytes);
  is_second_ = !is_second_;
  (void)!::pwrite(position_file_, text.data(), text.size(), at);
}

std::optional<JournalEntry> Journal::read() {
  if (path_.empty()) return std::nullopt;
  const auto text = read_small_file(path_, kMax_bytes);
  if (text && !*text) return std::nullopt;
  auto entry = text ? parse_journal(**text, machine_) : tl::make_unexpected(text.error());
  if (entry) {
    read_positions(position_name(path_), *entry);
    return *entry;
  }
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

void Journal::run(const std::function<void(const std::string&)>& complain,
                  const std::function<void()>& beside) noexcept {
  if (path_.empty()) return;
  int error_reported = 0;
  for (bool is_last = false; !is_last;) {
    is_last = is_stopping_.load();
    if (newest_.refresh()) {
      const int error = write_(path_, to_text(newest_.latest(), machine_));
      if (error != 0 && error != error_reported) {
        complain(fmt::format("the journal {} cannot be written: {}", path_.string(),
                             std::strerror(error)));
      }
      error_reported = error;
    }
    if (position_.refresh()) write_position();
    if (beside) beside();
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace meridian::telemetry
