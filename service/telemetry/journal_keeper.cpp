// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/journal_keeper.hpp"

#include "meridian/rt/state_table.hpp"

namespace meridian::telemetry {

void JournalKeeper::see(const Event& event, const std::string& alarm_words) noexcept {
  // In FaultStop the commanded path runs on, whether or not the drives follow: what it passes was
  // commanded, not cut.
  const bool is_run_out = entry_.state == State::kFaultStop;
  if (is_dry_run_) return;
  switch (event.code) {
    case EventCode::kStateChanged:
      enter(static_cast<State>(event.a));
      return;
    case EventCode::kBlockStarted:
    case EventCode::kBlockDone:
      if (is_run_out) return;
      entry_.block = event.a;
      entry_.line = static_cast<std::uint32_t>(event.b);
      entry_.reached = event.code == EventCode::kBlockDone ? Reached::kDone : Reached::kBegun;
      has_news_ = true;
      return;
    case EventCode::kProgramEnd:
      if (is_run_out) return;
      entry_.reached = Reached::kEnd;
      return;
    case EventCode::kAlarm:
      put_text(alarm_words, entry_.alarm);
      return;
    default:
      return;
  }
}

void JournalKeeper::enter(State state) noexcept {
  const bool is_start = state == State::kApproaching && !has_program_;
  has_program_ = has_program_ || is_start;
  if (!has_program_) return;
  entry_.state = state;
  is_urgent_ = is_urgent_ || is_start || !is_on_path(state);
  if (is_on_path(state)) {
    if (state != State::kFaultStop) entry_.alarm = {};  // whatever it was, the program goes on
    return;
  }
  // Held, Starved and Stepping go on; whatever else is at rest has done with the program.
  has_program_ = state == State::kHeld || state == State::kStarved || state == State::kStepping;
}

bool JournalKeeper::is_due(std::int64_t steady_ns) const noexcept {
  return is_urgent_ || (has_program_ && has_news_ && steady_ns - noted_ns_ >= kPeriod_ns);
}

std::optional<JournalEntry> JournalKeeper::due(const Owner& owner, std::int64_t steady_ns,
                                               std::int64_t time_ns) noexcept {
  if (!is_due(steady_ns)) return std::nullopt;
  if (owner.session != 0 && has_program_) {
    entry_.session = owner.session;
    put_text(owner.station, entry_.station);
    put_text(owner.program, entry_.program);
    put_text(owner.options, entry_.options);
  }
  entry_.time_ns = time_ns;
  noted_ns_ = steady_ns;
  is_urgent_ = has_news_ = false;
  return entry_;
}

}  // namespace meridian::telemetry
