// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/history.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include "service/text/printed.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

[[nodiscard]] std::string text_of(const json& line, const char* key) {
  const auto found = line.find(key);
  return found != line.end() && found->is_string() ? found->get<std::string>() : "";
}

/// "2026-09-21T14:13:20.123Z"; nothing for another text.
[[nodiscard]] std::optional<std::chrono::system_clock::time_point> time_of(
    const std::string& text) {
  std::tm utc{};
  const char* const rest = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &utc);
  if (rest == nullptr || *rest != '.') return std::nullopt;
  const auto seconds = std::chrono::system_clock::from_time_t(::timegm(&utc));
  const long milliseconds = std::clamp(std::strtol(rest + 1, nullptr, 10), 0L, 999L);
  return seconds + std::chrono::milliseconds(milliseconds);
}

[[nodiscard]] std::string argument_of(const json& line, const std::string& verb) {
  const auto found = line.find("argument");
  if (found == line.end() || !found->is_number()) return "";
  const double value = found->get<double>();
  if (verb == "feed_override" || verb == "rapid_override") {
    return text::printed(" %.0f %%", 100 * value);
  }
  const bool is_switch = verb == "single_block" || verb == "optional_stop" || verb == "dry_run";
  return is_switch ? (value != 0 ? " on" : " off") : "";
}

[[nodiscard]] NewsItem command_of(const json& line) {
  const std::string verb = text_of(line, "verb");
  std::string words = text_of(line, "name") + ": " + verb + argument_of(line, verb);
  const bool is_refused = text_of(line, "result") == "refused";
  if (is_refused) {
    const std::string reason = text_of(line, "text");
    words += ", refused: " + (reason.empty() ? text_of(line, "refusal") : reason);
  }
  NewsItem item;
  item.severity = is_refused ? Severity::kWarning : Severity::kNews;
  item.source = NewsSource::kOperator;
  item.text = std::move(words);
  return item;
}

}  // namespace

std::optional<NewsItem> parse_history_line(std::string_view text) {
  const json line = json::parse(text, nullptr, false);
  if (!line.is_object()) return std::nullopt;
  const auto time = time_of(text_of(line, "time"));
  if (!time) return std::nullopt;
  const std::string event = text_of(line, "event");
  NewsItem item;
  if (event == "command") {
    item = command_of(line);
  } else if (event == "session") {
    item.source = NewsSource::kStation;
    item.text = text_of(line, "name") + " streams " + text_of(line, "text");
  } else if (event == "fault") {
    item.severity = Severity::kAlarm;
    item.text = text_of(line, "text");
  } else if (event == "start" || event == "stop") {
    item.text = event == "start" ? "the service began" : "the service ended";
  } else {
    return std::nullopt;
  }
  item.time = *time;
  return item;
}

std::vector<NewsItem> History::take() {
  std::vector<NewsItem> items;
  const int file = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return items;
  struct stat facts {};
  if (::fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    static_cast<void>(::close(file));
    return items;
  }
  const auto size = static_cast<std::uint64_t>(facts.st_size);
  if (facts.st_ino != inode_ || size < read_to_) {
    inode_ = facts.st_ino;
    read_to_ = 0;
    torn_.clear();
  }
  // The line that a leap lands in is no whole one: it is no JSON, and passed over.
  read_to_ = std::max(read_to_, size > kMaxRead ? size - kMaxRead : 0);
  std::string text = std::move(torn_);
  const std::size_t before = text.size();
  text.resize(before + (size - read_to_));
  const ssize_t got =
      ::pread(file, text.data() + before, size - read_to_, static_cast<off_t>(read_to_));
  static_cast<void>(::close(file));
  text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  read_to_ += text.size() - before;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    if (auto item = parse_history_line(std::string_view(text).substr(begin, end - begin))) {
      items.push_back(std::move(*item));
    }
  }
  torn_ = text.substr(begin);
  return items;
}

}  // namespace meridian::panel
