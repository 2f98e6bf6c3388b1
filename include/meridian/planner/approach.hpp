// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "meridian/kinematics/joints.hpp"

namespace meridian {

/// How a program comes from where the machine rests to the begin of its first motion block, as it
/// was planned: off along the tool axis, every joint straight to where it is wanted, down along the
/// axis. Where the program begins in its middle its tool and spindle are restored behind the first
/// of these. Trivially copyable: travels from the planner to who declares it. Units: mm, rad, s.
struct Approach {
  bool is_planned = false;     ///< false: none is, by now
  std::uint16_t epoch = 0;     ///< of the program
  std::uint64_t sequence = 0;  ///< the block
  std::uint32_t line = 0;      ///< its source line
  JointVector from{}, to{};    ///< joints before it and behind it, windings included
  double retract = 0;          ///< mm along the tool axis, 0: none
  bool has_rest = false;       ///< behind the retraction the program's first actions are done
  double lift = 0;             ///< mm behind these, where they brought a tool that is longer
  double descent = 0;          ///< the same on the other side
  double length = 0;           ///< path length of the whole path, 1 rad counted as 50 mm
  double time = 0;             ///< s, at overrides of 100 %
  std::uint8_t branch = 0;     ///< solution of the inverse kinematics that `to` lies on
};
static_assert(std::is_trivially_copyable_v<Approach>);

}  // namespace meridian
