// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/creep_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace meridian::record {
namespace {

constexpr double kSlow = 1e-3;
constexpr double kLongest_s = 10;
/// From rest to rest no block takes longer that is so short.
constexpr double kVertex_s = 0.1;

}  // namespace

bool CreepCheck::is_slow(const Move& move) const noexcept {
  if (!(move.rate > 0)) return false;
  const double time = kSlow * move.rate * period_;
  if (move.tip_mm > time * move.feed_mm_per_s) return false;
  for (int i = 0; i < model_.joint_count; ++i) {
    if (std::abs(move.to[i] - move.from[i]) > time * model_.joints[i].limits.velocity) return false;
  }
  return true;
}

void CreepCheck::add(const Move& move, std::uint64_t cycle, std::uint32_t line) {
  if (cycle != last_cycle_ + 1 || !is_slow(move)) slow_s_ = 0;
  if (is_slow(move)) slow_s_ += period_;
  slow_s_ = std::max(0.0, slow_s_ - kVertex_s * static_cast<double>(move.vertices));
  last_cycle_ = cycle;
  longest_s_.raise(slow_s_, cycle, line);
}

void CreepCheck::finish(CheckReport& report) const {
  if (!(longest_s_.value > kLongest_s)) return;
  char text[128];
  std::snprintf(text, sizeof text,
                "the machine creeps for %.1f s, slower than a thousandth of the programmed feed",
                longest_s_.value);
  report.findings.push_back({Finding::Kind::kCreep, text, longest_s_.cycle, longest_s_.line,
                             static_cast<std::uint64_t>(longest_s_.value / period_)});
}

}  // namespace meridian::record
