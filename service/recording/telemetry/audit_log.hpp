// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/state.hpp"
#include "service/recording/telemetry/audit_queue.hpp"

namespace meridian::telemetry {

/// What a line of the audit log is about.
enum class AuditKind : std::uint8_t {
  kCommand,  ///< an operator's command, accepted or refused
  kStart,    ///< the service began
  kStop,     ///< the service ended in order
  kFault,    ///< the machine went to Fault; `text` is the alarm
  kSession,  ///< a station opened a session; `operator_name` is the station's name
};

/// Who did what. Of kinds other than kCommand verb, argument, is_accepted and refusal say nothing.
struct AuditEntry {
  std::int64_t time_ns = 0;  ///< system clock, since 1970; 0: append() sets it
  std::string identity{};    ///< of DDS, or process and host
  std::string operator_name{};
  std::uint64_t operator_id = 0, request = 0;
  Verb verb = Verb::kHold;
  double argument = 0;
  bool is_accepted = false;
  Refusal refusal = Refusal::kNone;
  State state = State::kOff;
  std::string text{};
  AuditKind kind = AuditKind::kCommand;
};

/// The entry as a line of JSON, its newline included. Whatever its texts hold, it is one line.
[[nodiscard]] std::string to_line(const AuditEntry& entry);

/// Where the audit log is kept.
struct AuditOptions {
  std::filesystem::path file;           ///< empty: none is kept
  std::uint64_t file_bytes = 16 << 20;  ///< a file that would be longer is put aside as FILE.1
  int files = 10;                       ///< so many are put aside, the oldest goes
};

/// The audit log of a machine: one line for everything that somebody did to it, appended to a file
/// by a thread of its own (docs/security.md). Whoever appends never waits: where the queue is full
/// the line is lost, counted, and the loss is a line of its own, as is one that the disk did not
/// take. Proof: tests/unit/telemetry/audit_log_test.cpp.
class AuditLog {
 public:
  static constexpr std::size_t kQueued = 1024;

  /// Opens the file, its folder is made where it is not there. Throws std::runtime_error where the
  /// file is a symbolic link or no regular file; what cannot be opened for another reason is a
  /// complaint of run(), which tries again.
  explicit AuditLog(AuditOptions options);
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  /// Any thread, at any time; never blocks.
  void append(AuditEntry entry) noexcept;

  /// The log's thread: writes until stop() and everything is on disk. `complain` hears once that it
  /// cannot be written, and again only when it could be meanwhile.
  void run(const std::function<void(const std::string&)>& complain) noexcept;
  void stop() noexcept { is_stopping_ = true; }

  [[nodiscard]] bool is_kept() const noexcept { return !options_.file.empty(); }
  /// Entries that found no room in the queue, ever.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

 private:
  void open();
  void rotate();
  [[nodiscard]] bool put(const std::string& line);
  void note_losses();
  void complain_once(const std::function<void(const std::string&)>& complain);

  AuditOptions options_;
  std::unique_ptr<AuditQueue<AuditEntry, kQueued>> queue_;
  std::atomic<bool> is_stopping_{false};
  std::atomic<std::uint64_t> lost_{0};
  std::uint64_t lost_noted_ = 0;   ///< of these, those that a line says
  std::uint64_t not_written_ = 0;  ///< lines that the disk did not take since the last that it did
  bool has_torn_line_ = false;     ///< the file ends within a line
  int file_ = -1, error_ = 0, complained_ = 0;
  std::uint64_t size_ = 0;
};

}  // namespace meridian::telemetry
