// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/journal_entry.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <ctime>
#include <optional>
#include <span>

#include "meridian/rt/state_table.hpp"
#include "service/dds/crc32c.hpp"

namespace meridian::telemetry {
namespace {

constexpr std::string_view kHead = "meridian journal 1";
constexpr std::string_view kCrcKey = "crc32c = ";
constexpr std::array<std::string_view, 3> kReached{"begun", "done", "end"};

[[nodiscard]] std::uint32_t crc_of(std::string_view text) noexcept {
  return dds::crc32c(std::as_bytes(std::span(text.data(), text.size())));
}

[[nodiscard]] std::string time_text(std::int64_t time_ns) {
  const auto seconds = static_cast<std::time_t>(time_ns / 1'000'000'000);
  std::tm utc{};
  (void)::gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", utc);
}

/// Takes lines of `key = value` from a text, one after the other.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  [[nodiscard]] std::string_view next() {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    const std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    return line;
  }
  /// The value of the next line if that has `key`; else empty, and has_failed().
  [[nodiscard]] std::string_view value(std::string_view key) {
    const std::string_view line = next();
    const bool is_key = line.starts_with(key) && line.substr(key.size()).starts_with(" = ");
    has_failed_ = has_failed_ || !is_key;
    return is_key ? line.substr(key.size() + 3) : std::string_view();
  }
  template <class Number>
  void read(std::string_view key, Number& number) {
    const std::string_view text = value(key);
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    has_failed_ = has_failed_ || error != std::errc() || rest != text.data() + text.size();
  }
  /// Finds the value among `names`.
  template <class Names>
  [[nodiscard]] int find(std::string_view key, int count, Names name) {
    const std::string_view text = value(key);
    for (int i = 0; i < count; ++i) {
      if (text == name(i)) return i;
    }
    has_failed_ = true;
    return 0;
  }
  [[nodiscard]] bool has_failed() const noexcept { return has_failed_; }

 private:
  std::string_view text_;
  bool has_failed_ = false;
};

/// What is wrong with a text as a whole; nothing: its head and its checksum are as they should be.
[[nodiscard]] std::optional<std::string> find_damage(std::string_view text) {
  if (!text.starts_with("meridian journal ")) return "is no journal of this service";
  if (!text.starts_with(kHead) || !text.substr(kHead.size()).starts_with("\n")) {
    return "is of another version of this service";
  }
  const std::size_t at = text.rfind(kCrcKey);
  if (at == std::string_view::npos) return "is torn: its end is missing";
  const std::string_view digits = text.substr(at + kCrcKey.size());
  std::uint32_t crc = 0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), crc, 16);
  const bool is_whole =
      error == std::errc() && std::string_view(rest, digits.data() + digits.size()) == "\n";
  if (!is_whole || crc != crc_of(text.substr(0, at))) return "is torn: its checksum is wrong";
  return std::nullopt;
}

}  // namespace

void put_text(std::string_view from, char* to, std::size_t size) noexcept {
  const std::size_t count = std::min(from.size(), size - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const auto c = static_cast<unsigned char>(from[i]);
    to[i] = c < 0x20 || c == 0x7f ? ' ' : from[i];
  }
  std::fill(to + count, to + size, '\0');
}

std::string to_text(const JournalEntry& entry, std::string_view machine) {
  std::string text = fmt::format(
      "{}\nmachine = {}\ntime_ns = {}\ntime = {}\nsession = {}\nstation = {}\nprogram = {}\n"
      "options = {}\nblock = {}\nline = {}\nreached = {}\nstate = {}\nalarm = {}\n",
      kHead, machine, entry.time_ns, time_text(entry.time_ns), entry.session, entry.station.data(),
      entry.program.data(), entry.options.data(), entry.block, entry.line,
      kReached[static_cast<std::size_t>(entry.reached)], name_of(entry.state), entry.alarm.data());
  const std::uint32_t crc = crc_of(text);
  return text + fmt::format("{}{:08X}\n", kCrcKey, crc);
}

Expected<JournalEntry, std::string> parse_journal(std::string_view text, std::string_view machine) {
  if (const auto damage = find_damage(text)) return tl::make_unexpected(*damage);
  Lines lines(text);
  (void)lines.next();
  const std::string_view owner = lines.value("machine");
  if (owner != machine) {
    return tl::make_unexpected(fmt::format("is of machine '{}', not of '{}'", owner, machine));
  }
  JournalEntry entry;
  lines.read("time_ns", entry.time_ns);
  (void)lines.value("time");
  lines.read("session", entry.session);
  put_text(lines.value("station"), entry.station);
  put_text(lines.value("program"), entry.program);
  put_text(lines.value("options"), entry.options);
  lines.read("block", entry.block);
  lines.read("line", entry.line);
  entry.reached = static_cast<Reached>(
      lines.find("reached", kReached.size(), [](int i) { return kReached[std::size_t(i)]; }));
  entry.state = static_cast<State>(
      lines.find("state", kStateCount, [](int i) { return name_of(static_cast<State>(i)); }));
  put_text(lines.value("alarm"), entry.alarm);
  if (lines.has_failed()) return tl::make_unexpected(std::string("holds something else"));
  return entry;
}

std::string describe(const JournalEntry& entry) {
  const std::string program = fmt::format("last program: {:.96}", entry.program.data());
  if (entry.reached == Reached::kEnd) return program + ", ran to its end";
  if (entry.state == State::kFaultStop || entry.state == State::kFault) {
    return fmt::format(
        "{}, line {} at the alarm, what was cut may end earlier (flight record); go on with "
        "--from-line {} at the latest",
        program, entry.line, entry.line);
  }
  if (entry.reached == Reached::kDone) {
    return fmt::format(
        "{}, line {} done up to block {}; go on with --from-line {}, or {} if that was all of line "
        "{}",
        program, entry.line, entry.block, entry.line, entry.line + 1, entry.line);
  }
  return fmt::format("{}, line {} {}; go on with --from-line {}", program, entry.line,
                     is_on_path(entry.state) ? "begun at least" : "begun", entry.line);
}

std::string describe_more(const JournalEntry& entry) {
  const auto add = [](const char* what, const char* value) {
    return *value == '\0' ? std::string() : fmt::format("; {} {}", what, value);
  };
  return fmt::format("noted {} in state {}, block {}{}{}{}", time_text(entry.time_ns),
                     name_of(entry.state), entry.block, add("station", entry.station.data()),
                     add("options", entry.options.data()), add("alarm:", entry.alarm.data()));
}

}  // namespace meridian::telemetry
