// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "meridian/cycle/cycle_data.hpp"
#include "service/recording/telemetry/journal/journal_entry.hpp"

namespace meridian::telemetry {

/// Decides from the events of the cycle when the journal gets a new entry, and which: whenever a
/// program begins, comes to rest or ends, and once a second while its blocks go on; the position
/// alone whenever there is a newer one. What the drives have not taken is not cut: an event counts
/// once they say that they took the setpoint of its cycle. After a fault it names the block in
/// which the alarm came, not where the commanded path ran out to. A dry run cuts nothing, nor
/// does a move between programs: what was noted before stays. One thread.
///
/// What a program is cut up to (JournalEntry::next_line) never goes back, whatever goes on with it
/// and is killed again; blocks in front of the line that a session begins with restore the machine
/// and do not count. It begins anew with another program, or with the same from its begin.
/// Proof: tests/unit/telemetry/journal_keeper_test.cpp, tests/property/protocol/recovery_test.cpp.
class JournalKeeper {
 public:
  static constexpr std::int64_t kPeriod_ns = 1'000'000'000;

  /// Who owns the program that runs, and what it is cut with.
  struct Owner {
    std::uint64_t session = 0;  ///< 0: none; the one before is kept
    std::string station{}, program{}, options{};
    std::uint64_t file_checksum = 0;
    std::uint32_t from_line = 0;
    CutSetup setup{};
    /// Whether block() ends its line; false where that is not known.
    bool is_line_end = false;
  };

  /// Before all else: what the service before left.
  void go_on_from(const JournalEntry& entry) noexcept { entry_ = entry; }

  /// Whether the events to come are of a dry run. It changes in Off alone, where nothing is noted:
  /// the newest view of the cycle is good enough, and is there where events were lost.
  void set_dry_run(bool is_dry_run) noexcept { is_dry_run_ = is_dry_run; }
  /// Whether the events to come are of an operator's move between programs, which is not noted
  /// either. It is known before the move can be started, and stays until another session opens.
  void set_move(bool is_move) noexcept { is_move_ = is_move; }

  /// Every event, in order; alarms with their words.
  void see(const Event& event, const std::string& alarm_words);
  /// The drives have taken the setpoint of this cycle. Before the first call they are taken to have
  /// all of them.
  void see_taken(std::uint64_t cycle);

  /// The entry that is to be written now, if one is. `steady_ns` spaces them, `time_ns` (system
  /// clock) is noted.
  [[nodiscard]] std::optional<JournalEntry> due(const Owner& owner, std::int64_t steady_ns,
                                                std::int64_t time_ns);
  /// The newest position, if it is newer than what due() and this gave last.
  [[nodiscard]] std::optional<JournalEntry> due_position(const Owner& owner, std::int64_t time_ns);
  /// Whether due() or due_position() would have one but for the owner: whoever has to look for that
  /// looks then.
  [[nodiscard]] bool is_due() const noexcept {
    return is_urgent_ || (has_program_ && has_position_);
  }
  /// The block that the machine is in, as far as the drives have come.
  [[nodiscard]] std::uint64_t block() const noexcept { return progress_.block; }

 private:
  /// How far the program in force has come by what the drives have taken.
  struct Progress {
    std::uint64_t block = 0;
    std::uint32_t line = 0;  ///< 0: no block was begun
    Reached reached = Reached::kBegun;
  };

  void enter(const Event& event);
  void count(const Event& event) noexcept;
  void begin(const Owner& owner);
  void bring_up_to_date(const Owner& owner, std::int64_t time_ns);

  JournalEntry entry_;  ///< as noted last
  Progress progress_;
  State state_ = State::kOff;
  std::array<char, 192> alarm_{};
  std::deque<Event> sent_;  ///< of blocks, that the drives have not come to yet
  std::uint64_t taken_cycle_ = std::numeric_limits<std::uint64_t>::max();
  bool has_program_ = false;   ///< one was started and is not over
  bool has_first_ = false;     ///< its first block was seen, its start not yet
  bool is_begun_ = false;      ///< it was started, and whose it is has not been asked yet
  bool is_urgent_ = false;     ///< begun, at rest or over
  bool has_news_ = false;      ///< a block began or ended since due() gave an entry
  bool has_position_ = false;  ///< the same, since due_position() did
  bool is_dry_run_ = false, is_move_ = false;
  std::int64_t noted_ns_ = 0;
};

}  // namespace meridian::telemetry
