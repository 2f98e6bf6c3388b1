// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "meridian/cycle/cycle_data.hpp"

namespace meridian::telemetry {

enum class ProgramEnd : std::uint8_t { kRan, kAborted, kFault };

/// What a program spends its time with.
enum class ProgramPart : std::uint8_t {
  kApproach,
  kCut,
  kRapid,
  kTurn,      ///< the redundant joint alone: on the pole, or turned back off the part
  kRest,      ///< dwells, and actions that are waited for
  kHeld,      ///< by a hold or a program stop, or by an override of 0
  kStarved,   ///< at rest, no blocks there
  kStepping,  ///< single block: after a block, waiting for the operator
};
inline constexpr std::size_t kProgramParts = 8;

/// How a program went, from its start until it was over. Lost periods count as the cycle behind
/// them.
struct ProgramSummary {
  ProgramEnd end = ProgramEnd::kRan;
  std::array<std::uint64_t, kProgramParts> cycles{};  ///< by ProgramPart
  std::uint64_t whole = 0;                            ///< cycles of all
  std::uint64_t blocks = 0;                           ///< done
  std::uint64_t block = 0;     ///< sequence of the last; in a fault of that in force when it came
  std::uint32_t line = 0;      ///< its source line
  bool is_block_done = false;  ///< it ended before the program did
  bool is_dry_run = false;     ///< no drive followed
};

/// Makes a summary of each program out of the records of the cycles: no event is waited for.
/// Proof: tests/unit/telemetry/program_summary_test.cpp.
class ProgramWatch {
 public:
  /// Every record, in order, with the overrides that were set by then.
  void see(const CycleRecord& record, double feed_override, double rapid_override) noexcept;

  /// The program that is over, once; nothing: none is.
  [[nodiscard]] std::optional<ProgramSummary> take() noexcept;

 private:
  void begin(const CycleRecord& record) noexcept;
  void end(const CycleRecord& record) noexcept;

  ProgramSummary now_;
  std::optional<ProgramSummary> over_;
  bool is_on_ = false;  ///< a program was started and is not over
  bool has_fault_ = false;
  std::uint16_t epoch_ = 0;
  std::uint64_t first_cycle_ = 0, last_cycle_ = 0;
};

/// A sentence of at most `room` characters, where that holds what cannot be left out: how the
/// program ended, whether it was dry, blocks and time; then its name, `program`, and its times by
/// parts.
[[nodiscard]] std::string describe(const ProgramSummary& summary, const std::string& program,
                                   double period_s, std::size_t room);

}  // namespace meridian::telemetry
