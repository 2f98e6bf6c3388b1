// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "meridian/expected.hpp"
#include "meridian/rt/state.hpp"

namespace meridian::telemetry {

/// How far the block that a journal names has come.
enum class Reached : std::uint8_t {
  kBegun,  ///< at least begun; where the state is one of motion, what came in the next second is
           ///< not known
  kDone,
  kEnd  ///< the program ran to its end
};

/// The last executed block of a program, and what it takes to go on with it. Plain data: it crosses
/// to the thread that writes it.
struct JournalEntry {
  std::int64_t time_ns = 0;  ///< system clock, since 1970
  std::uint64_t session = 0;
  std::uint64_t block = 0;  ///< counts from 0 in the session
  std::uint32_t line = 0;   ///< its source line
  Reached reached = Reached::kBegun;
  State state = State::kOff;
  std::array<char, 64> station{};   ///< texts end with a zero
  std::array<char, 128> program{};  ///< name of the CL file
  std::array<char, 192> options{};  ///< of `meridian stream`, with which its file was read
  std::array<char, 192> alarm{};    ///< in words; empty: none
};
static_assert(std::is_trivially_copyable_v<JournalEntry>);

/// Copies as much of `from` as fits; what would break a line becomes a space.
void put_text(std::string_view from, char* to, std::size_t size) noexcept;
template <std::size_t N>
void put_text(std::string_view from, std::array<char, N>& to) noexcept {
  put_text(from, to.data(), N);
}

/// The entry as the text of its file: a line each, the last a CRC-32C of all before it.
[[nodiscard]] std::string to_text(const JournalEntry& entry, std::string_view machine);

/// Reads what to_text() wrote for `machine`. The error says in what the text is none: of another
/// machine, of another program or version, or torn. Proof: tests/unit/telemetry/journal_test.cpp.
[[nodiscard]] Expected<JournalEntry, std::string> parse_journal(std::string_view text,
                                                                std::string_view machine);

/// What an operator is to know of it after a restart, in one line: the program, how far it came,
/// and from which line to go on. A line may be many blocks (an arc), so that the next one is right
/// only if the block named was its last; behind an alarm the drives may have left the path earlier.
[[nodiscard]] std::string describe(const JournalEntry& entry);

/// The rest of it, for the log: when, from which station, in which state, with which options, and
/// the alarm.
[[nodiscard]] std::string describe_more(const JournalEntry& entry);

}  // namespace meridian::telemetry
