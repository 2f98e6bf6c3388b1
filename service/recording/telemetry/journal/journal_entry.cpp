// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/journal_entry.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <sstream>

#include "meridian/cycle/state_table.hpp"
#include "service/recording/telemetry/journal/sealed_text.hpp"
#include "service/text/printable.hpp"

namespace meridian::telemetry {
namespace {

constexpr std::string_view kHead = "meridian journal 2";
constexpr std::string_view kPositionHead = "meridian-position-1";
constexpr std::array<std::string_view, 4> kReached{"begun", "done", "line done", "end"};

[[nodiscard]] std::string time_text(std::int64_t time_ns) {
  const auto seconds = static_cast<std::time_t>(time_ns / 1'000'000'000);
  std::tm utc{};
  (void)::gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", utc);
}

}  // namespace

void put_text(std::string_view from, char* to, std::size_t size) noexcept {
  const std::size_t count = text::whole_characters(from, size - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const auto c = static_cast<unsigned char>(from[i]);
    to[i] = c < 0x20 || c == 0x7f ? ' ' : from[i];
  }
  std::fill(to + count, to + size, '\0');
}

std::string to_text(const JournalEntry& entry, std::string_view machine) {
  const std::string text = fmt::format(
      "{}\nmachine = {}\ncount = {}\ntime_ns = {}\ntime = {}\nsession = {}\nstation = {}\nprogram "
      "= {}\n"
      "file_checksum = {}\noptions = {}\nframe = {}\nmachine_file = {}\ntools = {}\n"
      "tool_mm = {:.9g}\nfrom_line = {}\nnext_line = {}\nblock = {}\nline = {}\nreached = {}\n"
      "state = {}\nalarm = {}\ndropped = {}\n",
      kHead, machine, entry.count, entry.time_ns, time_text(entry.time_ns), entry.session,
      entry.station.data(), entry.program.data(), entry.file_checksum, entry.options.data(),
      entry.setup.frame, entry.setup.machine, entry.setup.tools, entry.setup.tool_mm,
      entry.from_line, entry.next_line, entry.block, entry.line,
      kReached[static_cast<std::size_t>(entry.reached)], name_of(entry.state), entry.alarm.data(),
      entry.dropped.data());
  return seal(text);
}

Expected<JournalEntry, std::string> parse_journal(std::string_view text, std::string_view machine) {
  if (const auto damage = find_damage(text, kHead, "journal")) return tl::make_unexpected(*damage);
  Lines lines(text);
  (void)lines.next();
  const std::string_view owner = lines.value("machine");
  if (owner != machine) {
    return tl::make_unexpected(fmt::format("is of machine '{}', not of '{}'", owner, machine));
  }
  JournalEntry entry;
  lines.read("count", entry.count);
  lines.read("time_ns", entry.time_ns);
  (void)lines.value("time");
  lines.read("session", entry.session);
  put_text(lines.value("station"), entry.station);
  put_text(lines.value("program"), entry.program);
  lines.read("file_checksum", entry.file_checksum);
  put_text(lines.value("options"), entry.options);
  lines.read("frame", entry.setup.frame);
  lines.read("machine_file", entry.setup.machine);
  lines.read("tools", entry.setup.tools);
  lines.read("tool_mm", entry.setup.tool_mm);
  lines.read("from_line", entry.from_line);
  lines.read("next_line", entry.next_line);
  lines.read("block", entry.block);
  lines.read("line", entry.line);
  entry.reached = static_cast<Reached>(
      lines.find("reached", kReached.size(), [](int i) { return kReached[std::size_t(i)]; }));
  entry.state = static_cast<State>(
      lines.find("state", kStateCount, [](int i) { return name_of(static_cast<State>(i)); }));
  put_text(lines.value("alarm"), entry.alarm);
  put_text(lines.value("dropped"), entry.dropped);
  if (lines.has_failed()) return tl::make_unexpected(std::string("holds something else"));
  return entry;
}

std::string to_position(const JournalEntry& entry) {
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {}", kPositionHead, entry.count, entry.session,
                  entry.time_ns, entry.block, entry.line, entry.next_line,
                  static_cast<unsigned>(entry.reached), static_cast<unsigned>(entry.state));
  const std::string end = fmt::format(" {:08X}\n", crc_of(text));
  text.append(kPositionBytes - text.size() - end.size(), ' ');
  return text + end;
}

void read_position(std::string_view text, JournalEntry& entry) {
  std::istringstream words{std::string(text)};
  std::string head;
  JournalEntry newer = entry;
  unsigned reached = 0, state = 0;
  if (!(words >> head >> newer.count >> newer.session >> newer.time_ns >> newer.block >>
        newer.line >> newer.next_line >> reached >> state)) {
    return;
  }
  if (head != kPositionHead || newer.session != entry.session || newer.count <= entry.count ||
      reached >= kReached.size() || state >= static_cast<unsigned>(kStateCount)) {
    return;
  }
  newer.reached = static_cast<Reached>(reached);
  newer.state = static_cast<State>(state);
  if (text == to_position(newer)) entry = newer;
}

std::string describe(const JournalEntry& entry) {
  const std::string program = fmt::format("last program: {:.80}", entry.program.data());
  if (entry.reached == Reached::kEnd) return program + ", ran to its end";
  const std::string go_on = fmt::format("; go on with --from-line {}", entry.next_line);
  const bool ended_by_fault = is_fault(entry.state);
  if (entry.next_line == 0) return program + ", not begun; stream it from its begin";
  if (is_recovering(entry)) {
    return fmt::format(
        "{}, cut up to line {}; begun again from line {}, it had not come to the cut{}{}", program,
        entry.next_line, entry.from_line, go_on, ended_by_fault ? " at the latest" : "");
  }
  if (entry.line < entry.next_line && entry.reached != Reached::kLineDone) {
    return fmt::format(
        "{}, cut up to line {}; begun again from line {}, it came to line {}{}, or {} "
        "for what was begun again",
        program, entry.next_line, entry.from_line, entry.line, go_on, entry.line);
  }
  if (ended_by_fault) {
    return fmt::format(
        "{}, line {} at the alarm, what was cut may end earlier (flight record){} at "
        "the latest",
        program, entry.line, go_on);
  }
  if (entry.reached == Reached::kLineDone) {
    return fmt::format("{}, line {} done{}", program, entry.line, go_on);
  }
  if (entry.reached == Reached::kDone) {
    return fmt::format("{}, line {} done up to block {}{}", program, entry.line, entry.block,
                       go_on);
  }
  return fmt::format("{}, line {} {}{}", program, entry.line,
                     is_on_path(entry.state) ? "begun at least" : "begun", go_on);
}

std::string describe_more(const JournalEntry& entry) {
  const auto add = [](const char* what, const char* value) {
    return *value == '\0' ? std::string() : fmt::format("; {} {}", what, value);
  };
  return fmt::format("noted {} in state {}, line {}, block {}{}{}{}{}", time_text(entry.time_ns),
                     name_of(entry.state), entry.line, entry.block,
                     add("station", entry.station.data()), add("options", entry.options.data()),
                     add("alarm:", entry.alarm.data()),
                     add("before it, not finished:", entry.dropped.data()));
}

}  // namespace meridian::telemetry
