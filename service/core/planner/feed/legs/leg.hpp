// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/path/path_piece.hpp"
#include "meridian/planner/time_piece.hpp"

namespace meridian {

/// A smooth stretch of a block from rest to rest, and how fast it may be run. Units: mm, rad, s.
struct Leg {
  PathPiece path;            ///< names, kind and joints_begin filled in
  double feed_mm_per_s = 0;  ///< programmed tip feed; 0: limited by the joints alone
  double share_per_s = 0;    ///< inverse time: largest d(share of the leg)/dt; 0: none
  double feed_factor = 1;    ///< on what is programmed: `share_per_s`, without one `feed_mm_per_s`
  std::uint32_t window = 0;

  /// The tip feed that is programmed, also by inverse time.
  [[nodiscard]] double tip_feed() const noexcept;
  /// Bound of the tip speed; infinite: none.
  [[nodiscard]] double max_tip_speed() const noexcept;
  /// Bound of ṡ where the share of the leg grows by `share_rate` per mm of s.
  [[nodiscard]] double max_velocity(double share_rate) const noexcept;
  /// The time piece of `piece`, a part of the leg, without a motion.
  [[nodiscard]] TimePiece time_on(const PathPiece& piece) const noexcept;
};

}  // namespace meridian
