// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"

namespace meridian {

/// Windings that the redundant joint may turn to where it rests, best first.
///
/// A joint that ran out of travel upwards has, as a rule, farther to go upwards: best is the
/// winding with the most room that way that leaves half a turn behind it, so that a path that
/// swings back does not end at once. Then those nearer to where it stands, then those with less
/// room behind. Windings outside travel are none. Unit: rad. No memory.
class UnwindChoice {
 public:
  /// `at`: where the joint rests; `beyond`: a value outside travel that it would have come to.
  UnwindChoice(const JointLimits& limits, double at, double beyond) noexcept;

  /// The next best, in whole turns from `at`; 0: there is none left.
  [[nodiscard]] int next() noexcept;

 private:
  int sign_ = -1;  ///< of the turns
  int most_ = 0;   ///< inside travel
  int best_ = 0;   ///< of them, with half a turn left behind
  int tried_ = 0;
};

}  // namespace meridian
