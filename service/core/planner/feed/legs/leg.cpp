// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/leg.hpp"

#include <algorithm>
#include <limits>

#include "meridian/path/build_piece.hpp"

namespace meridian {

double Leg::tip_feed() const noexcept {
  if (!(share_per_s > 0)) return feed_mm_per_s;
  const double feed = share_per_s * tip_length(path);
  return feed_mm_per_s > 0 ? std::min(feed, feed_mm_per_s) : feed;
}

double Leg::max_tip_speed() const noexcept {
  if (!(feed_mm_per_s > 0)) return std::numeric_limits<double>::infinity();
  return share_per_s > 0 ? feed_mm_per_s : feed_factor * feed_mm_per_s;
}

double Leg::max_velocity(double share_rate) const noexcept {
  constexpr double kBelow = 1 - 1e-7;  // never above the feed, whatever rounding does
  double velocity = std::numeric_limits<double>::max();
  const double tip_rate = tip_length(path) * share_rate;
  if (tip_rate > 0) velocity = std::min(velocity, kBelow * max_tip_speed() / tip_rate);
  if (share_per_s > 0 && share_rate > 0) {
    velocity = std::min(velocity, kBelow * feed_factor * share_per_s / share_rate);
  }
  return velocity;
}

TimePiece Leg::time_on(const PathPiece& piece) const noexcept {
  TimePiece time;
  time.kind = TimeKind::kMove;
  time.is_from_rest = true;
  time.epoch = piece.epoch;
  time.window = window;
  time.path_index = piece.index;
  time.sequence = piece.sequence;
  time.line = piece.line;
  time.feed_mm_per_s = tip_feed();
  time.feed_factor = feed_factor;
  return time;
}

}  // namespace meridian
