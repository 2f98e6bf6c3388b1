// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/feed_overrides.hpp"

#include <algorithm>
#include <charconv>

#include "meridian/cycle/state_table.hpp"

namespace meridian::record {
namespace {

/// Reads a number at the begin of `text` and takes it off.
template <class Number>
[[nodiscard]] bool take_number(std::string_view& text, Number& value) {
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
  return error == std::errc();
}

}  // namespace

std::optional<std::vector<FeedOverride>> read_feed_overrides(std::string_view text) {
  const std::string_view verb = name_of(Verb::kFeedOverride);
  std::vector<FeedOverride> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view row = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row == "incomplete") return std::nullopt;
    FeedOverride set;
    if (!take_number(row, set.cycle) || !row.starts_with(',')) continue;
    row.remove_prefix(1);
    if (!row.starts_with(verb) || !row.substr(verb.size()).starts_with(',')) continue;
    row.remove_prefix(verb.size() + 1);
    if (take_number(row, set.factor)) out.push_back(set);
  }
  return out;
}

double FeedInForce::at(std::uint64_t cycle) noexcept {
  while (next_ < set_.size() && set_[next_].cycle <= cycle) ++next_;
  double max = 0;
  for (std::size_t n = next_; n > 0; --n) {
    max = std::max(max, set_[n - 1].factor);
    if (set_[n - 1].cycle + ramp_ <= cycle) return max;
  }
  return std::max(max, 1.0);
}

}  // namespace meridian::record
