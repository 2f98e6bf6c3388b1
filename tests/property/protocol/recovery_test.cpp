// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <random>
#include <vector>

#include "service/protocol/station/line_ends.hpp"
#include "service/recording/telemetry/journal/journal_keeper.hpp"
#include "support/draws.hpp"

/// Programs that are broken off and gone on with by the line that the journal names, again and
/// again, until they have run: every line is cut, and none that was finished is cut again.
namespace meridian {
namespace {

using telemetry::JournalEntry;
using telemetry::JournalKeeper;

/// How a run is broken off.
enum class End : std::uint8_t { kAbort, kFault, kDrivesDie, kServiceDies, kRan };

/// Source lines of a program's blocks: lines grow, some have many blocks, some have none.
std::vector<std::uint32_t> draw_program(std::mt19937& engine) {
  std::vector<std::uint32_t> lines;
  std::uint32_t line = 0;
  const std::size_t count = 20 + engine() % 100;
  while (lines.size() < count) {
    line += static_cast<std::uint32_t>(1 + (engine() % 4 == 0 ? engine() % 5 : 0));
    const std::size_t blocks = engine() % 5 == 0 ? 2 + engine() % 6 : 1;
    lines.insert(lines.end(), blocks, line);
  }
  return lines;
}

/// A machine that cuts, its drives, and the journal that its service keeps.
class Machine {
 public:
  Machine(std::mt19937& engine, std::vector<std::uint32_t> lines)
      : engine_(engine), lines_(std::move(lines)), cuts_(lines_.size(), 0) {}

  /// Runs the program from the first block of `from_line` on (0: from its begin) until `end`, no
  /// later than its own end. Returns whether it ran to that.
  bool run(std::uint32_t from_line, End end) {
    const auto first = static_cast<std::size_t>(
        std::lower_bound(lines_.begin(), lines_.end(), from_line) - lines_.begin());
    const bool has_restored = from_line > 0 && first > 0;
    const std::size_t restored = has_restored ? 1 + engine_() % 3 : 0;
    owner_ = {++session_, "cam", "part.apt", ""};
    owner_.from_line = from_line;
    ends_.clear();
    std::vector<std::size_t> blocks(restored, SIZE_MAX);
    for (std::size_t i = first; i < lines_.size(); ++i) blocks.push_back(i);
    for (std::size_t i = 0; i < blocks.size(); ++i) ends_.add(i, line_of(blocks, i, first));
    ends_.end();
    drives_live_ = true;
    const std::size_t last = end == End::kRan ? blocks.size() : engine_() % blocks.size();
    step(EventCode::kBlockStarted, 0, line_of(blocks, 0, first));
    enter(State::kApproaching);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (i > 0) step(EventCode::kBlockStarted, i, line_of(blocks, i, first));
      if (i == restored) enter(State::kRunning);
      if (i == last && engine_() % 2 == 0) return break_off(end, i, blocks, first);
      if (engine_() % 4 == 0) ++cycle_;
      step(EventCode::kBlockDone, i, line_of(blocks, i, first));
      if (blocks[i] != SIZE_MAX && drives_live_) ++cuts_[blocks[i]];
      if (i == last) return break_off(end, i, blocks, first);
    }
    step(EventCode::kProgramEnd, blocks.size(), 0);
    enter(State::kReady);
    poll();
    return true;
  }

  [[nodiscard]] const JournalEntry& journal() const { return disk_; }
  /// Of every block, how often it was cut to its end.
  [[nodiscard]] const std::vector<int>& cuts() const { return cuts_; }
  [[nodiscard]] const std::vector<std::uint32_t>& lines() const { return lines_; }
  /// The first line of which a block is not cut.
  [[nodiscard]] std::uint32_t unfinished_line() const {
    const auto at = std::find(cuts_.begin(), cuts_.end(), 0);
    return at == cuts_.end() ? lines_.back() + 1
                             : lines_[static_cast<std::size_t>(at - cuts_.begin())];
  }

 private:
  [[nodiscard]] std::uint32_t line_of(const std::vector<std::size_t>& blocks, std::size_t i,
                                      std::size_t first) const {
    return blocks[i] != SIZE_MAX ? lines_[blocks[i]] : lines_[engine_() % first];
  }
  bool break_off(End end, std::size_t i, const std::vector<std::size_t>& blocks,
                 std::size_t first) {
    if (end == End::kDrivesDie) {
      drives_live_ = false;
      const std::size_t passed = engine_() % 4;  // until the service misses them
      for (std::size_t n = i + 1; n < std::min(i + 1 + passed, blocks.size()); ++n) {
        step(EventCode::kBlockStarted, n, line_of(blocks, n, first));
        step(EventCode::kBlockDone, n, line_of(blocks, n, first));
      }
    }
    if (end == End::kServiceDies) {
      keeper_ = JournalKeeper();
      keeper_.go_on_from(disk_);
      return false;
    }
    if (end == End::kAbort) {
      enter(State::kAborting);
      enter(State::kReady);
    } else {
      see(EventCode::kAlarm, 0, 0);
      enter(State::kFaultStop);
      for (std::size_t n = i + 1; n < std::min(i + 3, blocks.size()); ++n) {
        step(EventCode::kBlockStarted, n, line_of(blocks, n, first));
      }
      enter(State::kFault);
    }
    poll();
    ++epoch_;
    return false;
  }
  void see(EventCode code, std::uint64_t a, std::uint64_t b) {
    keeper_.see({.code = code, .cycle = cycle_, .a = a, .b = b, .epoch = epoch_}, "an alarm");
  }
  void enter(State state) {
    see(EventCode::kStateChanged, static_cast<std::uint64_t>(state), 0);
    poll();
  }
  void step(EventCode code, std::uint64_t block, std::uint32_t line) {
    ++cycle_;
    see(code, block, line);
    poll();
  }
  /// The service looks, and what it notes is on the disk.
  void poll() {
    if (drives_live_) keeper_.see_taken(cycle_);
    now_ns_ += 10'000'000;
    owner_.is_line_end = ends_.is_line_end(keeper_.block());
    if (const auto entry = keeper_.due(owner_, now_ns_, now_ns_)) disk_ = *entry;
    if (const auto entry = keeper_.due_position(owner_, now_ns_)) disk_ = *entry;
  }

  std::mt19937& engine_;
  const std::vector<std::uint32_t> lines_;
  std::vector<int> cuts_;
  JournalKeeper keeper_;
  JournalKeeper::Owner owner_;
  stream::LineEnds ends_;
  JournalEntry disk_;
  std::uint64_t session_ = 0, cycle_ = 0;
  std::uint16_t epoch_ = 0;
  bool drives_live_ = true;
  std::int64_t now_ns_ = 0;
};

TEST(Recovery, CutsEveryLineAndNoneThatIsFinishedAgainWhateverIsKilledHoweverOften) {
  const auto seed = test::number_of<std::uint32_t>("MERIDIAN_RECOVERY_SEED", 20261123);
  const int programs = test::number_of("MERIDIAN_RECOVERY_PROGRAMS", 2000);
  std::printf("seed %u, %d programs\n", seed, programs);
  std::mt19937 engine(seed);
  int recoveries = 0;
  for (int n = 0; n < programs; ++n) {
    SCOPED_TRACE(testing::Message() << "program " << n);
    Machine machine(engine, draw_program(engine));
    std::uint32_t from_line = 0;
    for (int run = 0;; ++run) {
      const bool is_last = run > 12;
      const End end = is_last ? End::kRan : static_cast<End>(engine() % 4);
      if (machine.run(from_line, end)) break;
      const JournalEntry& journal = machine.journal();
      const std::uint32_t unfinished = machine.unfinished_line();
      if (unfinished > machine.lines().back()) break;  // all of it is cut
      const auto& all = machine.lines();
      const auto named = std::lower_bound(all.begin(), all.end(), journal.next_line);
      ASSERT_NE(named, all.end());
      ASSERT_EQ(*named, unfinished) << "run " << run << " from " << from_line;
      ASSERT_GE(journal.next_line, from_line) << "went back";
      from_line = journal.next_line;
      ++recoveries;
    }
    const auto& cuts = machine.cuts();
    const auto& lines = machine.lines();
    ASSERT_EQ(std::count(cuts.begin(), cuts.end(), 0), 0) << "a block was passed over";
    // Of a line of many blocks those are cut again that it was broken off behind; no other.
    std::map<std::uint32_t, int> min_cuts;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const auto [at, is_new] = min_cuts.emplace(lines[i], cuts[i]);
      if (!is_new) at->second = std::min(at->second, cuts[i]);
    }
    for (const auto& [line, times] : min_cuts) ASSERT_EQ(times, 1) << "line " << line;
  }
  EXPECT_GT(recoveries, 5 * programs);
}

}  // namespace
}  // namespace meridian
