// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "meridian/rt/cycle_data.hpp"
#include "service/telemetry/journal_entry.hpp"

namespace meridian::telemetry {

/// Decides from the events of the cycle when the journal gets a new entry, and which: whenever a
/// program begins, comes to rest or ends, and once a second while its blocks go on. Behind a fault
/// it names the block in which the alarm came, not where the commanded path ran out to. A dry run
/// cuts nothing: what was noted before stays. One thread. Proof:
/// tests/unit/telemetry/journal_keeper_test.cpp.
class JournalKeeper {
 public:
  static constexpr std::int64_t kPeriod_ns = 1'000'000'000;

  /// Who owns the program that runs.
  struct Owner {
    std::uint64_t session = 0;  ///< 0: none; the one before is kept
    std::string station, program, options;
  };

  /// Whether the events to come are of a dry run. It changes in Off alone, where nothing is noted:
  /// the newest view of the cycle is good enough, and is there where events were lost.
  void set_dry_run(bool is_dry_run) noexcept { is_dry_run_ = is_dry_run; }

  /// Every event, in order; alarms with their words.
  void see(const Event& event, const std::string& alarm_words) noexcept;

  /// The entry that is to be written now, if one is. `steady_ns` spaces them, `time_ns` (system
  /// clock) is noted.
  [[nodiscard]] std::optional<JournalEntry> due(const Owner& owner, std::int64_t steady_ns,
                                                std::int64_t time_ns) noexcept;
  /// Whether due() would have one but for the owner: whoever has to look for that looks then.
  [[nodiscard]] bool is_due(std::int64_t steady_ns) const noexcept;

 private:
  void enter(State state) noexcept;

  JournalEntry entry_;
  bool has_program_ = false;  ///< one was started and is not over
  bool is_urgent_ = false;    ///< begun, at rest or over
  bool has_news_ = false;     ///< a block began or ended
  bool is_dry_run_ = false;
  std::int64_t noted_ns_ = 0;
};

}  // namespace meridian::telemetry
