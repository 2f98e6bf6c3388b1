// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "meridian/cycle/latest_value.hpp"
#include "service/recording/telemetry/journal/journal_entry.hpp"

namespace meridian::telemetry {

/// Puts `content` in place of what `path` holds, so that after a crash or a loss of power
/// either is there and whole: a new file, synced, renamed, its folder synced. 0, or the errno of
/// what failed; then the old one stands. Blocks as long as the disk does.
[[nodiscard]] int replace_file(const std::filesystem::path& path, const std::string& content);

/// The journal of one machine: the last executed block, in a file that survives the service. It is
/// written by a thread of its own; a disk that is slow, blocked or full hinders nobody, and the
/// newest entry is what is written next. Proof: tests/unit/telemetry/journal_test.cpp.
class Journal {
 public:
  using Write = std::function<int(const std::filesystem::path&, const std::string&)>;

  /// `folder` empty: no journal is kept. It is made where it is not there. `write` is for tests.
  Journal(const std::filesystem::path& folder, std::string machine, Write write = replace_file);

  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What the service before left, nothing where it left none; to be called ahead of run(). A file
  /// that is no journal of this machine, torn, unreadable or no regular file is put aside as
  /// NAME.refused and complaint() says so.
  [[nodiscard]] std::optional<JournalEntry> read();

  /// Telemetry thread: this is what is true now.
  void take(const JournalEntry& entry) noexcept { newest_.store(entry); }

  /// The same, of what due_position() of the keeper gives: it goes into a file beside, in place and
  /// not synced, so that a service that is killed leaves it; a loss of power may cost it.
  void take_position(const JournalEntry& entry) noexcept { position_.store(entry); }

  /// Journal's thread: writes until stop() and the newest entry is on disk. `complain` hears once
  /// that it cannot be written, and again only when it could be meanwhile. `beside` is called at
  /// every turn: another file of the same folder is written by this thread too.
  void run(const std::function<void(const std::string&)>& complain,
           const std::function<void()>& beside = {}) noexcept;
  void stop() noexcept { is_stopping_ = true; }

  [[nodiscard]] bool is_kept() const noexcept { return !path_.empty(); }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Behind the constructor and read(): what is wrong, empty if nothing is.
  [[nodiscard]] const std::string& complaint() const noexcept { return complaint_; }

 private:
  void put_aside(const std::string& why);
  void write_position() noexcept;

  std::string machine_;
  std::filesystem::path path_;
  Write write_;
  std::string complaint_;
  LatestValue<JournalEntry> newest_, position_;
  int position_file_ = -1;
  bool is_second_ = false;  ///< the newest position is the second in its file
  std::atomic<bool> is_stopping_{false};
};

}  // namespace meridian::telemetry
