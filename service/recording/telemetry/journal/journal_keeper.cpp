// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/journal_keeper.hpp"

#include <algorithm>

#include "meridian/cycle/state_table.hpp"
#include "service/recording/telemetry/journal/recovery.hpp"

namespace meridian::telemetry {
namespace {

/// More events of blocks than a program makes while drives are silent and no fault was seen.
constexpr std::size_t kMaxSent = 65'536;

}  // namespace

void JournalKeeper::see(const Event& event, const std::string& alarm_words) {
  // In FaultStop the commanded path runs on, whether or not the drives follow: what it passes was
  // commanded, not cut.
  const bool is_run_out = state_ == State::kFaultStop;
  if (is_dry_run_ || is_move_) return;
  switch (event.code) {
    case EventCode::kStateChanged:
      return enter(event);
    case EventCode::kBlockStarted:
      if (!has_program_ && !has_first_) {
        progress_ = {};
        has_first_ = true;
      }
      [[fallthrough]];
    case EventCode::kBlockDone:
    case EventCode::kProgramEnd:
      if (is_run_out) return;
      if (event.cycle <= taken_cycle_ && sent_.empty()) return count(event);
      if (sent_.size() < kMaxSent) sent_.push_back(event);
      return;
    case EventCode::kAlarm:
      put_text(alarm_words, alarm_);
      return;
    default:
      return;
  }
}

void JournalKeeper::see_taken(std::uint64_t cycle) {
  if (cycle == 0) return;
  taken_cycle_ = cycle;
  for (; !sent_.empty() && sent_.front().cycle <= cycle; sent_.pop_front()) {
    count(sent_.front());
    // At rest nothing else would bring it to the disk.
    if (!is_on_path(state_)) is_urgent_ = true;
  }
}

void JournalKeeper::count(const Event& event) noexcept {
  has_news_ = has_position_ = true;
  if (event.code == EventCode::kProgramEnd) {
    progress_.reached = Reached::kEnd;
    return;
  }
  progress_.block = event.a;
  progress_.line = static_cast<std::uint32_t>(event.b);
  progress_.reached = event.code == EventCode::kBlockDone ? Reached::kDone : Reached::kBegun;
}

void JournalKeeper::enter(const Event& event) {
  const auto state = static_cast<State>(event.a);
  state_ = state;
  const bool is_start = state == State::kApproaching && !has_program_;
  has_program_ = has_program_ || is_start;
  if (!has_program_) return;
  if (is_start) {
    // What drives never took of the program before is void.
    const auto is_old = [&](const Event& old) { return old.epoch != event.epoch; };
    sent_.erase(std::remove_if(sent_.begin(), sent_.end(), is_old), sent_.end());
    if (!has_first_) progress_ = {};
    has_first_ = false;
    is_begun_ = true;
  }
  is_urgent_ = is_urgent_ || is_start || !is_on_path(state);
  if (is_on_path(state)) {
    if (state != State::kFaultStop) alarm_ = {};  // whatever it was, the program goes on
    return;
  }
  // Held, Starved and Stepping go on; whatever else is at rest has done with the program.
  has_program_ = state == State::kHeld || state == State::kStarved || state == State::kStepping;
}

/// Whose program was started: what it is cut up to stands where it goes on with what is noted.
void JournalKeeper::begin(const Owner& owner) {
  const bool goes_on = owner.from_line > 0 && is_unfinished(entry_) &&
                       is_same_program(entry_, owner.program, owner.file_checksum);
  std::string dropped;
  if (!goes_on && is_unfinished(entry_)) {
    dropped =
        std::string(entry_.program.data()) + ", cut up to line " + std::to_string(entry_.next_line);
  }
  put_text(dropped, entry_.dropped);
  if (!goes_on) entry_.next_line = 0;
  entry_.session = owner.session;
  entry_.from_line = owner.from_line;
  entry_.file_checksum = owner.file_checksum;
  entry_.setup = owner.setup;
  put_text(owner.station, entry_.station);
  put_text(owner.program, entry_.program);
  put_text(owner.options, entry_.options);
  entry_.reached = Reached::kBegun;
  is_begun_ = false;
}

void JournalKeeper::bring_up_to_date(const Owner& owner, std::int64_t time_ns) {
  if (is_begun_ && owner.session != 0) begin(owner);
  const bool was_line_end = entry_.reached == Reached::kLineDone && entry_.block == progress_.block;
  const bool is_line_end = was_line_end || (owner.is_line_end && owner.session == entry_.session);
  entry_.block = progress_.block;
  entry_.line = progress_.line;
  entry_.reached = progress_.reached;
  if (entry_.reached == Reached::kDone && is_line_end) entry_.reached = Reached::kLineDone;
  // What restores the machine, and the approach, is of lines in front of the first.
  if (entry_.line != 0 && !is_recovering(entry_)) {
    const std::uint32_t next = entry_.line + (entry_.reached == Reached::kLineDone ? 1 : 0);
    entry_.next_line = std::max(entry_.next_line, next);
  }
  entry_.state = state_;
  entry_.alarm = alarm_;
  entry_.time_ns = time_ns;
  ++entry_.count;
  has_position_ = false;
}

std::optional<JournalEntry> JournalKeeper::due(const Owner& owner, std::int64_t steady_ns,
                                               std::int64_t time_ns) {
  const bool is_old = has_program_ && has_news_ && steady_ns - noted_ns_ >= kPeriod_ns;
  if (!is_urgent_ && !is_old) return std::nullopt;
  bring_up_to_date(owner, time_ns);
  noted_ns_ = steady_ns;
  is_urgent_ = has_news_ = false;
  return entry_;
}

std::optional<JournalEntry> JournalKeeper::due_position(const Owner& owner, std::int64_t time_ns) {
  if (!has_program_ || !has_position_) return std::nullopt;
  bring_up_to_date(owner, time_ns);
  return entry_;
}

}  // namespace meridian::telemetry
