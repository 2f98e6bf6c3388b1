// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/feed/legs/leg.hpp"
#include "service/core/planner/feed/legs/path_choice.hpp"
#include "service/core/planner/feed/rolling/rolling_feed.hpp"
#include "service/core/planner/feed/stop/feed_stop_margin.hpp"
#include "service/core/planner/route/staging.hpp"

namespace meridian {

/// Plans a leg by the feed planner: as one motion from rest to rest over the true derivatives of
/// the joints along it.
///
/// The cells of the feed are of equal time at full speed, and shorter towards both ends, where the
/// motion is slower. However long a leg takes, there are no more of them than its store holds.
///
/// Fixed store; a pure function of the leg. Units: mm, rad, s. Context: planner thread. Source:
/// docs/motion.md, section 4. Proof: tests/property/planner/leg_time_test.cpp.
class LegFeed {
 public:
  explicit LegFeed(const MachineModel& model);

  /// Plans `leg` from `joints`, which become those at its end, stages it and returns its duration;
  /// 0: there is no plan that takes less than `less_than_s`, and nothing is staged. `cells` are
  /// those of the leg by path length.
  [[nodiscard]] double plan(const Leg& leg, std::span<const JointCell> cells, double less_than_s,
                            Staging& out, JointVector& joints) noexcept;

 private:
  /// The motion as far as it is staged.
  struct Times {
    TimePiece names;  ///< what is the same of all pieces
    double less_than_s = 0, duration = 0;
  };

  /// How far the machine comes from a rest in the time of a first cell.
  [[nodiscard]] double length_from_rest(const JointCell& rest) const noexcept;
  /// Places the ends of cells on the leg; there is at least one cell.
  void set_cells(const Leg& leg, std::span<const JointCell> cells) noexcept;
  [[nodiscard]] double time_over(const Leg& leg, const JointCell& cell) const noexcept;
  /// Pushes all cells, and stages the windows that make room for them.
  [[nodiscard]] bool push_cells(const Leg& leg, Times& times, Staging& out) noexcept;
  /// Stages the motion of the windows whose cells are there. False: it takes `less_than_s` or
  /// longer, crawls, or has no room.
  [[nodiscard]] bool stage_windows(Times& times, Staging& out) noexcept;

  const MachineModel& model_;
  RollingFeed feed_;
  FeedStopMargin stop_margin_;
  std::vector<double> ends_, finer_;  ///< of the cells, by path length
};

/// A time that no motion on a leg with such `cells` falls much below: `caps` where they are
/// easiest, and everywhere the velocity that there is.
[[nodiscard]] double min_leg_time(const Leg& leg, std::span<const JointCell> cells,
                                  const JointCaps& caps) noexcept;

}  // namespace meridian
