// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/audit_log.hpp"

#include <fcntl.h>
#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "service/text/printable.hpp"
#include "service/text/printed.hpp"

namespace meridian::telemetry {
namespace {

/// Commands and stations are named in it: it is not everybody's.
constexpr mode_t kAuditMode = 0640;
constexpr std::array<const char*, 5> kKinds{"command", "start", "stop", "fault", "session"};

[[nodiscard]] std::int64_t since_1970_ns() noexcept {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

[[nodiscard]] std::string utc_text(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000, kMillisecond_ns = 1'000'000;
  const auto seconds = static_cast<std::time_t>(time_ns / kSecond_ns);
  std::tm utc{};
  (void)::gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", utc, time_ns % kSecond_ns / kMillisecond_ns);
}

[[nodiscard]] std::string json_text(const std::string& text) {
  return text::json_quoted(text::printable(text));
}

/// A value that this build does not name came from the wire: it is shown as its number.
template <class Enum>
[[nodiscard]] std::string name_or_number(Enum value, Enum last) {
  const auto number = static_cast<unsigned>(value);
  return number <= static_cast<unsigned>(last) ? name_of(value) : std::to_string(number);
}

/// A line about the log itself.
[[nodiscard]] std::string lost_line(std::uint64_t count, const char* why) {
  return fmt::format(R"({{"time":"{}","event":"lost","lines":{},"text":{}}})"
                     "\n",
                     utc_text(since_1970_ns()), count, json_text(why));
}

}  // namespace

std::string to_line(const AuditEntry& entry) {
  std::string line = fmt::format(R"({{"time":"{}","event":"{}")", utc_text(entry.time_ns),
                                 kKinds.at(static_cast<std::size_t>(entry.kind)));
  const auto add = [&line](const char* key, const std::string& value) {
    line += fmt::format(R"(,"{}":{})", key, value);
  };
  if (entry.kind == AuditKind::kCommand) {
    add("verb", json_text(name_or_number(entry.verb, Verb(kVerbCount - 1))));
    add("argument", text::json_number("%.9g", entry.argument));
    add("result", entry.is_accepted ? R"("accepted")" : R"("refused")");
    if (!entry.is_accepted) {
      add("refusal", json_text(name_or_number(entry.refusal, Refusal::kGuardOpen)));
    }
  }
  add("state", json_text(name_or_number(entry.state, State(kStateCount - 1))));
  if (!entry.operator_name.empty()) add("name", json_text(entry.operator_name));
  if (entry.operator_id != 0) add("operator_id", fmt::format(R"("{:016x}")", entry.operator_id));
  if (entry.request != 0) add("request", std::to_string(entry.request));
  if (!entry.identity.empty()) add("from", json_text(entry.identity));
  if (!entry.text.empty()) add("text", json_text(entry.text));
  return line + "}\n";
}

AuditLog::AuditLog(AuditOptions options) : options_(std::move(options)) {
  if (!is_kept()) return;
  queue_ = std::make_unique<AuditQueue<AuditEntry, kQueued>>();
  std::error_code ignored;
  std::filesystem::create_directories(options_.file.parent_path(), ignored);
  open();
  if (error_ == ELOOP) {
    throw std::runtime_error("audit log " + options_.file.string() +
                             " is a symbolic link, which is not followed; name a regular file");
  }
  if (error_ == ENXIO || error_ == EINVAL || error_ == EISDIR) {
    throw std::runtime_error("audit log " + options_.file.string() + " is no regular file");
  }
}

AuditLog::~AuditLog() {
  if (file_ >= 0) (void)::close(file_);
}

void AuditLog::append(AuditEntry entry) noexcept {
  if (!queue_) return;
  if (entry.time_ns == 0) entry.time_ns = since_1970_ns();
  if (!queue_->try_push(std::move(entry))) lost_.fetch_add(1, std::memory_order_relaxed);
}

/// Sets `error_`; no link is followed, no pipe waited for.
void AuditLog::open() {
  constexpr int kFlags = O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
  file_ = ::open(options_.file.c_str(), kFlags, kAuditMode);
  error_ = file_ < 0 ? errno : 0;
  if (file_ < 0) return;
  struct stat facts {};
  if (::fstat(file_, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    (void)::close(file_);
    file_ = -1;
    error_ = EINVAL;
    return;
  }
  size_ = static_cast<std::uint64_t>(facts.st_size);
  char last = '\n';
  // What a service that was killed or a full disk left.
  if (size_ > 0) {
    const int again = ::open(options_.file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (again >= 0) {
      (void)::pread(again, &last, 1, facts.st_size - 1);
      (void)::close(again);
    }
  }
  has_torn_line_ = last != '\n';
}

/// FILE becomes FILE.1, that FILE.2 and so on. Where that fails the file grows on.
void AuditLog::rotate() {
  const std::string name = options_.file.string();
  const auto aside = [&name](int n) { return name + "." + std::to_string(n); };
  for (int n = options_.files - 1; n >= 1; --n) {
    (void)::rename(aside(n).c_str(), aside(n + 1).c_str());
  }
  const bool is_aside = options_.files > 0 ? ::rename(name.c_str(), aside(1).c_str()) == 0
                                           : ::unlink(name.c_str()) == 0;
  if (!is_aside) return;
  (void)::fsync(file_);
  (void)::close(file_);
  open();
}

/// Appends all of `line`; false where not all of it could be: it counts as lost.
bool AuditLog::put(const std::string& line) {
  if (file_ >= 0 && size_ > 0 && size_ + line.size() > options_.file_bytes) rotate();
  if (file_ < 0) open();
  if (file_ < 0) return false;
  const std::string text = has_torn_line_ ? "\n" + line : line;
  ssize_t count = 0;
  do count = ::write(file_, text.data(), text.size());
  while (count < 0 && errno == EINTR);
  error_ = count < 0 ? errno : count < static_cast<ssize_t>(text.size()) ? ENOSPC : 0;
  if (count > 0) {
    size_ += static_cast<std::uint64_t>(count);
    has_torn_line_ = text[static_cast<std::size_t>(count) - 1] != '\n';
  }
  return error_ == 0;
}

/// Ahead of the next line, what is missing in front of it.
void AuditLog::note_losses() {
  const std::uint64_t lost = lost_;
  if (lost > lost_noted_ &&
      put(lost_line(lost - lost_noted_, "came faster than they were written"))) {
    lost_noted_ = lost;
  }
  if (not_written_ > 0 && put(lost_line(not_written_, "could not be written"))) not_written_ = 0;
}

void AuditLog::complain_once(const std::function<void(const std::string&)>& complain) {
  if (error_ != 0 && error_ != complained_) {
    complain(fmt::format("the audit log {} cannot be written: {}", options_.file.string(),
                         std::strerror(error_)));
  }
  complained_ = error_;
}

void AuditLog::run(const std::function<void(const std::string&)>& complain) noexcept {
  if (!is_kept()) return;
  constexpr int kLooksBetweenSyncs = 50;
  int looks = 0;
  AuditEntry entry;
  for (bool is_last = false, is_dirty = false; !is_last;) {
    is_last = is_stopping_.load();
    while (queue_->try_pop(entry)) {
      note_losses();
      not_written_ += put(to_line(entry)) ? 0 : 1;
      is_dirty = true;
    }
    if (is_last || not_written_ > 0 || lost_ > lost_noted_) note_losses();
    complain_once(complain);
    if (is_dirty && (is_last || ++looks >= kLooksBetweenSyncs)) {
      (void)::fdatasync(file_);
      is_dirty = false;
      looks = 0;
    }
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace meridian::telemetry
