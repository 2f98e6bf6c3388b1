// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/events_file.hpp"

#include <algorithm>
#include <charconv>

namespace meridian::ros {

EventsFile::EventsFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  std::string header;
  if (std::getline(file_, header)) line_ = 1;
}

Expected<std::optional<EventsRow>, record::RecordError> EventsFile::next() {
  std::string text;
  if (!std::getline(file_, text)) return std::nullopt;
  ++line_;
  if (!text.empty() && text.back() == '\r') text.pop_back();
  EventsRow row;
  if (text == "incomplete") {
    row.is_incomplete = true;
    return row;
  }
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), row.cycle);
  const auto at = static_cast<std::size_t>(rest - text.data());
  if (error != std::errc() || at + 1 >= text.size() || text[at] != ',') {
    return tl::make_unexpected(record::RecordError{
        path_, line_, "'" + text.substr(0, 40) + "' is no row cycle,verb,argument",
        "mend the row, or move the file away to convert the recording without its events"});
  }
  row.text = text.substr(at + 1);
  std::replace(row.text.begin(), row.text.end(), ',', ' ');
  return row;
}

}  // namespace meridian::ros
