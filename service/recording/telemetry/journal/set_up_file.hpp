// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "meridian/expected.hpp"
#include "service/recording/telemetry/journal/journal.hpp"
#include "service/recording/telemetry/journal/set_up_text.hpp"

namespace meridian::telemetry {

/// The set-up of one machine in a file that survives the service, NAME.setup beside the journal.
/// One thread asks that a set-up be written and looks later whether it is; another one writes. The
/// file is replaced as a whole, so that whoever kills the service leaves the old one or the new
/// one. Proof: tests/unit/telemetry/set_up_file_test.cpp, tests/integration/set_up_test.cpp.
class SetUpFile {
 public:
  /// Where the newest ask() has come to.
  enum class Progress : std::uint8_t {
    kNone,     ///< nothing is asked
    kAsked,    ///< not on disk yet
    kWritten,  ///< on disk, synced
    kFailed    ///< what stood there stands; error() says why
  };

  /// `folder` empty: none is kept. `write` is for tests.
  SetUpFile(const std::filesystem::path& folder, std::string machine,
            Journal::Write write = replace_file);

  [[nodiscard]] bool is_kept() const noexcept { return !path_.empty(); }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Before all else: what the service before left, an empty one where it left none. The error
  /// says why the file is no set-up of this machine.
  [[nodiscard]] Expected<SetUp, std::string> read();

  /// Asking thread, not while the one before is kAsked.
  void ask(const SetUp& set_up);
  /// Asking thread: how far it is; an end of it is reported once.
  [[nodiscard]] Progress look() noexcept;
  /// Asking thread, behind kFailed: errno.
  [[nodiscard]] int error() const noexcept { return error_; }

  /// Writing thread: writes what was asked for, if anything.
  void work() noexcept;

 private:
  std::string machine_;
  std::filesystem::path path_;
  Journal::Write write_;
  SetUp asked_;    ///< whose it is says progress_: kAsked, the writing thread's
  SetUp written_;  ///< what the file holds; the writing thread's
  int error_ = 0;
  std::atomic<Progress> progress_{Progress::kNone};
  static_assert(std::atomic<Progress>::is_always_lock_free);
};

}  // namespace meridian::telemetry
