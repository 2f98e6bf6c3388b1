// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/planner/feed_mark.hpp"
#include "service/core/path/index_ring.hpp"

namespace meridian {

/// Factors on the programmed feed of a stretch of path.
struct FeedFactors {
  double label = 1;    ///< the cycle runs the stretch at the override over this
  double planned = 1;  ///< the feed is planned with, never more than the label
};

/// What the feed override above 100 % is in the plan, stretch by stretch.
///
///     label    ▁▁▁▁▁▛▀▀▀▀▀▀▀▀▀▜▁▁▁▁     A stretch is never faster than its label, so the cycle may
///     planned  ▁▁▁▁▁▁▁▁▁▛▀▀▀▀▀▜▁▁▁▁     run it at override / label. Where the factor rises, the
///                   ├lead┤               label does so earlier by the time that the rate needs: an
///                                        override lowered meanwhile is in force when the feed
///                                        rises.
///
/// Source: docs/motion.md, section 9. Context: planner thread; takes no memory.
class FeedRaise {
 public:
  explicit FeedRaise(const MachineModel& model)
      : max_factor_(model.max_feed_override),
        ramp_s_(model.override_ramp_s),
        reported_(kReported) {}

  /// From the next begin() on the factors are those of a run before, whatever is asked for. `marks`
  /// must stay.
  void replay(std::span<const FeedMark> marks) noexcept {
    marks_ = marks;
    is_replay_ = true;
  }

  /// A program begins, with a tool so long in the spindle.
  void begin(double tool_length_mm) noexcept;

  /// What a look ahead went over (FeedMark::looked_at).
  void note_look(const FeedMark& look) noexcept {
    if (!is_replay_) reported_.push_over_oldest(look);
  }

  /// The machine rests before the next stretch.
  void rest() noexcept { is_at_rest_ = true; }

  /// Factors of the next stretch, which is of block `sequence` and takes `min_s` or longer at the
  /// programmed feed. `asked`: the operator's override.
  [[nodiscard]] FeedFactors next(std::uint64_t sequence, double asked, double min_s) noexcept;

  /// Takes the oldest mark of what was planned; false if there is none. At most 256 wait.
  [[nodiscard]] bool take(FeedMark& out) noexcept { return reported_.take_oldest(out); }

 private:
  static constexpr std::size_t kReported = 256;

  [[nodiscard]] double find_wanted(double asked) noexcept;

  double max_factor_, ramp_s_;
  FeedFactors now_;
  double lead_s_ = 0;  ///< that the label still has to be ahead of the plan
  bool is_at_rest_ = true;
  std::uint64_t sequence_ = 0;  ///< of the last stretch
  std::uint32_t span_ = 0;      ///< stretches of its block so far
  bool is_replay_ = false;
  std::span<const FeedMark> marks_;
  std::size_t next_mark_ = 0;
  double replayed_ = 1;
  IndexRing<FeedMark> reported_;
};

}  // namespace meridian
