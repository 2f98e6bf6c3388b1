// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/program_summary.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>

namespace meridian::telemetry {
namespace {

/// Whether a program that was started is not over in `state`.
[[nodiscard]] bool is_in_program(State state) noexcept {
  switch (state) {
    case State::kApproaching:
    case State::kRunning:
    case State::kHolding:
    case State::kHeld:
    case State::kStarving:
    case State::kStarved:
    case State::kStepping:
    case State::kAborting:
    case State::kFaultStop:
      return true;
    default:
      return false;
  }
}

/// Whether the machine rests after the block of its record.
[[nodiscard]] bool is_after_block(State state) noexcept {
  return state == State::kStepping || state == State::kStarved;
}

[[nodiscard]] ProgramPart part_of(MotionKind motion) noexcept {
  switch (motion) {
    case MotionKind::kApproach:
      return ProgramPart::kApproach;
    case MotionKind::kRapid:
      return ProgramPart::kRapid;
    case MotionKind::kPoleTurn:
    case MotionKind::kRewind:
      return ProgramPart::kTurn;
    case MotionKind::kCut:
      break;
  }
  return ProgramPart::kCut;
}

[[nodiscard]] ProgramPart part_of(const CycleRecord& record, bool is_override_zero) noexcept {
  if (record.state == State::kHeld) return ProgramPart::kHeld;
  if (record.state == State::kStarved) return ProgramPart::kStarved;
  if (record.state == State::kStepping) return ProgramPart::kStepping;
  if ((record.setpoint.flags & kSetpointMoving) != 0) return part_of(record.motion);
  const bool goes_on = record.state == State::kApproaching || record.state == State::kRunning;
  const bool is_at_barrier = goes_on && !(is_override_zero && record.rate == 0);
  return is_at_barrier ? ProgramPart::kRest : ProgramPart::kHeld;
}

[[nodiscard]] std::string end_of(const ProgramSummary& summary) {
  if (summary.end == ProgramEnd::kRan) return "ran to its end";
  return fmt::format("{} {} block {}, line {}",
                     summary.end == ProgramEnd::kAborted ? "was aborted" : "ended by a fault",
                     summary.is_block_done ? "after" : "in", summary.block, summary.line);
}

/// The parts that took long enough to be printed.
[[nodiscard]] std::string parts_of(const ProgramSummary& summary, double period_s) {
  constexpr std::array<const char*, kProgramParts> kNames{
      "approach",           "cut",  "rapid",   "turns of the redundant joint",
      "dwells and actions", "held", "starved", "single block"};
  constexpr double kShown_s = 0.05;
  std::string text;
  for (std::size_t i = 0; i < kProgramParts; ++i) {
    const double time_s = static_cast<double>(summary.cycles[i]) * period_s;
    if (time_s < kShown_s) continue;
    text += fmt::format("{}{} {:.1f}", text.empty() ? " (" : ", ", kNames[i], time_s);
  }
  return text.empty() ? text : text + ")";
}

}  // namespace

void ProgramWatch::see(const CycleRecord& record, double feed_override,
                       double rapid_override) noexcept {
  const bool was_on = is_on_;
  if (!was_on && record.state == State::kApproaching) begin(record);
  if (!is_on_) return;
  if (!is_in_program(record.state)) return end(record);
  const std::uint64_t cycles = record.setpoint.cycle - last_cycle_;
  const bool is_override_zero = feed_override == 0 || rapid_override == 0;
  now_.cycles[static_cast<std::size_t>(part_of(record, is_override_zero))] += cycles;
  last_cycle_ = record.setpoint.cycle;
  has_fault_ = has_fault_ || record.state == State::kFaultStop;
  if (has_fault_) return;  // what the commanded path passes now was commanded, not cut
  now_.block = record.sequence;
  now_.line = record.setpoint.line;
  now_.is_block_done = is_after_block(record.state);
}

void ProgramWatch::begin(const CycleRecord& record) noexcept {
  now_ = {};
  now_.is_dry_run = (record.setpoint.flags & kSetpointDry) != 0;
  is_on_ = true;
  has_fault_ = false;
  epoch_ = record.setpoint.epoch;
  first_cycle_ = record.setpoint.cycle;
  last_cycle_ = first_cycle_ - 1;
}

void ProgramWatch::end(const CycleRecord& record) noexcept {
  is_on_ = false;
  now_.whole = last_cycle_ + 1 - first_cycle_;
  // A program that ran to its end leaves its epoch as it was: nothing of it has to be dropped.
  const bool is_over = record.setpoint.epoch == epoch_;
  has_fault_ = has_fault_ || record.state == State::kFault;
  now_.end = has_fault_ ? ProgramEnd::kFault : is_over ? ProgramEnd::kRan : ProgramEnd::kAborted;
  if (!has_fault_ && record.sequence != now_.block) {
    now_.block = record.sequence;
    now_.line = record.setpoint.line;
    now_.is_block_done = false;
  }
  now_.blocks = now_.block + (now_.is_block_done ? 1 : 0);
  over_ = now_;
}

std::optional<ProgramSummary> ProgramWatch::take() noexcept {
  return std::exchange(over_, std::nullopt);
}

std::string describe(const ProgramSummary& summary, const std::string& program, double period_s,
                     std::size_t room) {
  const std::string went = fmt::format(" {}{}: {} blocks in {:.1f} s", end_of(summary),
                                       summary.is_dry_run ? " (dry run)" : "", summary.blocks,
                                       static_cast<double>(summary.whole) * period_s);
  const std::string parts = parts_of(summary, period_s);
  const std::string no_name = "the program";
  const std::string name = program.empty() ? no_name : "program " + program;
  if ((name + went + parts).size() <= room) return name + went + parts;
  if ((no_name + went + parts).size() <= room) return no_name + went + parts;
  return (name + went).size() <= room ? name + went : no_name + went;
}

}  // namespace meridian::telemetry
