// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/planner/rewind.hpp"
#include "service/core/planner/route/route_ahead.hpp"

namespace meridian {

/// A solution that a rewind may lead to, and what is known of it. Units: rad, s.
struct RewindSolution {
  RewindTarget target;
  double time_s = 0;  ///< of the turn at the joints' velocities, and of the blocks that are known
  int carries = 0;    ///< blocks after which all is inside travel, of those known
  double room = 0;    ///< see room_of(), where the blocks known do not show the end; else 0
};

/// Solutions for the pose where the tool rests, best first: those that carry farthest through the
/// blocks ahead, of these the ones with the most room, then with the least time. Fixed store.
class RewindSolutions {
 public:
  static constexpr std::size_t kMax = 24;

  /// Where the store is full nothing is added.
  void add(const RewindSolution& one) noexcept {
    if (count_ < kMax) solutions_[count_++] = one;
  }
  [[nodiscard]] std::span<RewindSolution> all() noexcept { return {solutions_.data(), count_}; }
  /// Equal ones stay as they were added.
  void sort() noexcept;

 private:
  std::array<RewindSolution, kMax> solutions_{};
  std::size_t count_ = 0;
};

/// The joints of `pose` on the branch that `branch` is not, with windings inside travel near
/// `near`; nothing where it has no solution there. The machine has a redundant joint. Units: mm,
/// rad.
[[nodiscard]] std::optional<JointVector> solve_other_branch(const MachineModel& model,
                                                            double tool_length_mm,
                                                            const ToolPose& pose, int branch,
                                                            const JointVector& near) noexcept;

/// What a joint at `at` that runs out of travel upwards (or not) has left that way. A path that
/// swings back would end at once where less than half a turn is left behind: less than 0 there, the
/// less the nearer that end is. Unit: rad.
[[nodiscard]] double room_of(const JointLimits& limits, double at, bool is_upwards) noexcept;

}  // namespace meridian
