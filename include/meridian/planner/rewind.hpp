// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/joints.hpp"

namespace meridian {

/// A rewind in the plan: a joint would have left its travel in a block, and the machine goes to
/// another winding or branch ahead of it, off the part (RewindPolicy::kRetract). Units: rad, mm.
struct Rewind {
  std::uint64_t sequence = 0;  ///< block in which the travel would have ended
  std::uint32_t line = 0;      ///< its source line
  std::int16_t turns = 0;      ///< of the redundant joint on the branch in force; 0: to the other
  std::int16_t joint = -1;     ///< that would have left its travel; -1: no rewind
  double from_rad = 0;         ///< where the redundant joint stood
  double turn_rad = 0;         ///< by which it turns
  double retract_mm = 0;       ///< how far the tool leaves the part

  [[nodiscard]] bool is_made() const noexcept { return joint >= 0; }
  [[nodiscard]] bool is_other_branch() const noexcept { return is_made() && turns == 0; }
};

/// Where a joint, or a drive of the stage, would leave its travel: its index in limited.hpp and the
/// value, outside travel, that it would come to. Unit: mm or rad.
struct TravelEnd {
  int joint = -1;
  double value = 0;
};

/// Where a rewind leads: another solution for the pose where the tool rests. Unit: rad.
struct RewindTarget {
  JointVector joints{};
  std::int32_t turns = 0;  ///< of the redundant joint on the branch in force; 0: to the other
  int branch = 0;          ///< of `joints`

  [[nodiscard]] bool is_other_branch() const noexcept { return turns == 0; }
};

/// Says of every solution whether what follows a rewind keeps travel on it.
class RewindTrial {
 public:
  virtual ~RewindTrial() = default;
  [[nodiscard]] virtual bool fits(const RewindTarget& target) const noexcept = 0;
};

}  // namespace meridian
