// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/rolling/feed_raise.hpp"

#include <tuple>

namespace meridian {
namespace {

/// What a change of the rate takes beside its share of the ramp: to turn round, to get going and to
/// settle, s (RateBounds: slope over curvature each).
constexpr double kSettle_s = 0.3;

}  // namespace

void FeedRaise::begin(double tool_length_mm) noexcept {
  now_ = {};
  lead_s_ = 0;
  is_at_rest_ = true;
  sequence_ = 0;
  span_ = 0;
  next_mark_ = 0;
  replayed_ = 1;
  if (!is_replay_) {
    reported_.push_over_oldest({.is_begin = true, .tool_length_mm = tool_length_mm});
  }
}

double FeedRaise::find_wanted(double asked) noexcept {
  if (!is_replay_) return std::clamp(asked, 1.0, max_factor_);
  for (; next_mark_ < marks_.size(); ++next_mark_) {
    const FeedMark& mark = marks_[next_mark_];
    if (mark.looked_at > 0) continue;
    if (std::tie(mark.sequence, mark.span) > std::tie(sequence_, span_)) break;
    replayed_ = std::clamp(mark.factor, 1.0, max_factor_);
  }
  return replayed_;
}

FeedFactors FeedRaise::next(std::uint64_t sequence, double asked, double min_s) noexcept {
  if (!(max_factor_ > 1)) return now_;
  if (sequence > sequence_) {
    sequence_ = sequence;
    span_ = 0;
  }
  if (const double wanted = find_wanted(asked); wanted != now_.label) {
    if (!is_replay_) reported_.push_over_oldest({false, sequence_, span_, wanted});
    if (wanted > now_.label) lead_s_ = ramp_s_ * (1 - now_.planned / wanted) + kSettle_s;
    now_ = {wanted, std::min(now_.planned, wanted)};
  }
  if (is_at_rest_ || lead_s_ <= 0) now_.planned = now_.label;
  lead_s_ -= min_s / now_.planned;
  is_at_rest_ = false;
  ++span_;
  return now_;
}

}  // namespace meridian
