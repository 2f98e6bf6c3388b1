// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/path/block_reject.hpp"

namespace meridian {

/// What became of a route as far as it was looked at.
enum class RouteEnd : std::uint8_t {
  kNone,     ///< all is inside travel
  kDoubt,    ///< something is outside, by no more than rounding inside the slack may make of it or
             ///< on a branch that is not certain, or is at a box
  kRewinds,  ///< a joint runs out of travel, and a rewind may help there
  kLost      ///< something leaves its travel for certain: the program cannot be cut this way
};

/// A branch and winding at the pose where a route starts, and how far it leads.
struct RouteAhead {
  int branch = 0;
  double free = 0;  ///< the redundant joint at the start, rad
  int carries = 0;  ///< blocks after which all is inside travel and past boxes, of those looked at
  double time_s = 0;  ///< of them: by the feed, or by the joint that is slowest
  RouteEnd end = RouteEnd::kNone;
  BlockReject lost{};  ///< kLost: the block, the joint and where it comes to
};

/// How far the path that is cut may lie from the programmed one; 0: it is that one.
struct LookAheadSlack {
  double tip_mm = 0, axis_rad = 0;
};

}  // namespace meridian
