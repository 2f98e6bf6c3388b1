// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "service/recording/telemetry/journal/journal_entry.hpp"
#include "service/transport/convert/messages.hpp"

/// Going on with a program that was not finished. Proof: tests/unit/telemetry/recovery_test.cpp.
namespace meridian::telemetry {

/// Whether a program of this name and checksum (0: not known) is the one that `last` is about: by
/// their checksums where both are known, else by their names.
[[nodiscard]] bool is_same_program(const JournalEntry& last, const std::string& program,
                                   std::uint64_t file_checksum) noexcept;

/// Why a session that goes on in the middle of a program (`from_line`) must not: its file, options
/// or workpiece frame are others than those that the program was begun with. Empty: it may, also
/// where it says that it means the change (dds::kPolicyChanged), begins the program anew or is of
/// another one.
[[nodiscard]] std::string refusal_to_go_on(const JournalEntry& last,
                                           const dds::SessionRequest& request,
                                           const CutSetup& setup);

/// What an operator should know ahead of the start: which unfinished program the session's drops
/// from the journal, which lines it passes over, that the machine's file or its tools are others
/// than before. Empty: nothing, as of a move, which leaves the journal as it is.
[[nodiscard]] std::string remark_on(const JournalEntry& last, const dds::SessionRequest& request,
                                    const CutSetup& setup);

/// The newest entry of the journal, for threads that do not keep it.
class LastProgram {
 public:
  void set(const JournalEntry& entry) {
    const std::lock_guard lock(mutex_);
    entry_ = entry;
  }
  [[nodiscard]] JournalEntry get() const {
    const std::lock_guard lock(mutex_);
    return entry_;
  }

 private:
  mutable std::mutex mutex_;
  JournalEntry entry_;
};

}  // namespace meridian::telemetry
