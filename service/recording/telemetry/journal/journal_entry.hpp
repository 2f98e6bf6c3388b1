// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "meridian/cycle/state.hpp"
#include "meridian/expected.hpp"

namespace meridian::telemetry {

/// How far the block that a journal names has come.
enum class Reached : std::uint8_t {
  kBegun,     ///< at least begun; where the state is one of motion, what came in the next tenth of
              ///< a second is not known
  kDone,      ///< done; whether it is the last of its line is not known
  kLineDone,  ///< done, and all of its line with it
  kEnd        ///< the program ran to its end
};

/// What a program is cut with, beside its file and options.
struct CutSetup {
  std::uint64_t frame = 0;    ///< checksum of the workpiece's frame; 0: not known
  std::uint64_t machine = 0;  ///< of the machine file's text
  std::uint64_t tools = 0;    ///< of the tool table's text
  double tool_mm = 0;         ///< gauge line to tip of the tool in the spindle
};

/// How far a program was cut, and what it takes to go on with it: two positions. `next_line` is
/// what it is cut up to; as long as the program is the same it never goes back. `line` is where the
/// machine was, be it on its way back to the cut. Plain data: it crosses to the thread that writes
/// it.
struct JournalEntry {
  std::uint64_t count = 0;   ///< of all entries and positions of this machine, this one's number
  std::int64_t time_ns = 0;  ///< system clock, since 1970
  std::uint64_t session = 0;
  std::uint64_t block = 0;  ///< counts from 0 in the session
  std::uint32_t line = 0;   ///< its source line
  Reached reached = Reached::kBegun;
  State state = State::kOff;
  std::uint32_t from_line = 0;      ///< that the session began with; 0: with the program's first
  std::uint32_t next_line = 0;      ///< the first that is not finished; 0: nothing was begun
  std::uint64_t file_checksum = 0;  ///< of the program's file; 0: not known
  CutSetup setup{};
  std::array<char, 64> station{};   ///< texts end with a zero
  std::array<char, 128> program{};  ///< name of the CL file
  std::array<char, 192> options{};  ///< of `meridian stream`, with which its file was read
  std::array<char, 192> alarm{};    ///< in words; empty: none
  std::array<char, 192> dropped{};  ///< the unfinished program in whose stead this one was begun
};
static_assert(std::is_trivially_copyable_v<JournalEntry>);

/// Whether the machine has not come back to the cut yet: what it does restores what the lines in
/// front of `from_line` leave, and approaches.
[[nodiscard]] constexpr bool is_recovering(const JournalEntry& entry) noexcept {
  return entry.line < entry.from_line;
}
/// Whether there is a program to go on with.
[[nodiscard]] constexpr bool is_unfinished(const JournalEntry& entry) noexcept {
  return entry.session != 0 && entry.reached != Reached::kEnd && entry.next_line != 0;
}

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

/// Bytes of a position in its file, which holds two of them.
inline constexpr std::size_t kPositionBytes = 256;

/// What of an entry changes from block to block, as a line of kPositionBytes with its CRC-32C.
[[nodiscard]] std::string to_position(const JournalEntry& entry);

/// Brings `entry` up to date by what to_position() wrote, if that is whole, of the same session and
/// newer; else nothing happens. Proof: tests/unit/telemetry/journal_test.cpp.
void read_position(std::string_view text, JournalEntry& entry);

/// What an operator is to know of it after a restart, in one line: the program, how far it came,
/// and from which line to go on, the first that is not finished. After an alarm the drives may
/// have left the path earlier.
[[nodiscard]] std::string describe(const JournalEntry& entry);

/// The rest of it, for the log: when, from which station, in which state, with which options, and
/// the alarm.
[[nodiscard]] std::string describe_more(const JournalEntry& entry);

}  // namespace meridian::telemetry
