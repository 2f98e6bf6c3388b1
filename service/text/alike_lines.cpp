// SPDX-License-Identifier: Apache-2.0
#include "service/text/alike_lines.hpp"

#include <algorithm>
#include <utility>

namespace meridian::text {
namespace {

/// The same for lines that differ in numbers, hexadecimal ones too, alone.
[[nodiscard]] std::uint64_t hash_of(std::string_view line) noexcept {
  std::uint64_t hash = 0xCBF29CE484222325U;
  bool is_number = false;
  for (const char c : line) {
    const bool is_digit = c >= '0' && c <= '9';
    const bool is_hex = is_number && ((c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == 'x');
    if (is_number && (is_digit || is_hex)) continue;
    is_number = is_digit;
    hash = (hash ^ (is_digit ? 0U : static_cast<unsigned char>(c))) * 0x100000001B3U;
  }
  return hash;
}

[[nodiscard]] std::string count_of(std::uint64_t left_out, const std::string& first) {
  return std::to_string(left_out) + " more lines like: " + first;
}

}  // namespace

AlikeLines::Kind& AlikeLines::kind_of(std::string_view line, std::int64_t now_ns) {
  const std::uint64_t hash = hash_of(line);
  const auto same = std::find_if(kinds_.begin(), kinds_.end(), [hash](const Kind& kind) {
    return kind.seen > 0 && kind.hash == hash;
  });
  Kind& kind =
      same != kinds_.end()
          ? *same
          : *std::min_element(kinds_.begin(), kinds_.end(), [](const Kind& a, const Kind& b) {
              return (a.seen > 0 ? a.since_ns : INT64_MIN) < (b.seen > 0 ? b.since_ns : INT64_MIN);
            });
  const bool is_over = now_ns - kind.since_ns >= kWhile_ns;
  if (same == kinds_.end() || is_over) {
    constexpr std::size_t kMaxCounted = 32;
    if (kind.seen > kPassing && counted_.size() < kMaxCounted) {
      counted_.push_back(count_of(kind.seen - kPassing, kind.first));
    }
    kind = {hash, now_ns, 0, std::string(line.substr(0, 160))};
  }
  return kind;
}

bool AlikeLines::pass(std::string_view line, std::int64_t now_ns) {
  return ++kind_of(line, now_ns).seen <= kPassing;
}

std::vector<std::string> AlikeLines::counts(std::int64_t now_ns, bool all) {
  for (Kind& kind : kinds_) {
    if (kind.seen == 0 || (!all && now_ns - kind.since_ns < kWhile_ns)) continue;
    if (kind.seen > kPassing) counted_.push_back(count_of(kind.seen - kPassing, kind.first));
    kind = {};
  }
  return std::exchange(counted_, {});
}

}  // namespace meridian::text
