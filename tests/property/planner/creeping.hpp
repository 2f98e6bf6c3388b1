// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "property/planner/plan_trace.hpp"

/// A plan that creeps keeps a machine Running for hours without a word.
namespace meridian::test {

inline constexpr double kSlow = 1e-3;  ///< of the programmed feed, and of every joint's velocity
inline constexpr double kLongestCreep_s = 10;

/// Whether neither the tool nor any joint gets anywhere in a piece of a cut.
[[nodiscard]] inline bool is_creeping(const MachineModel& model, const TimePiece& time,
                                      const PathPiece& path) {
  if (time.kind != TimeKind::kMove || !(time.feed_mm_per_s > 0)) return false;
  const double from = time.s0, to = state_at(time, time.duration).s;
  if (to - from > kSlow * time.feed_mm_per_s * time.duration) return false;
  const JointVector begin = joints_at(model, path, from, path.joints_begin).q;
  const JointVector end = joints_at(model, path, to, begin).q;
  for (int i = 0; i < model.joint_count; ++i) {
    const double max_distance = kSlow * model.joints[i].limits.velocity * time.duration;
    if (std::abs(end[i] - begin[i]) > max_distance) return false;
  }
  return true;
}

[[nodiscard]] inline double longest_creep_s(const MachineModel& model, const Trace& trace) {
  double longest = 0, creeps = 0;
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    const bool is_slow = is_creeping(model, trace.times[n], trace.paths[n]);
    creeps = is_slow ? creeps + trace.times[n].duration : 0;
    longest = std::max(longest, creeps);
  }
  return longest;
}

}  // namespace meridian::test
