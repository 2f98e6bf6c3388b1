// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "meridian/geometry/jet.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/time_law.hpp"

/// The least time to rest on a path, from the joint limits along it alone.
namespace meridian::test {

/// Interval of s̈ or s⃛ that every joint allows.
struct Interval {
  double low = -1e12, high = 1e12;
  /// Adds |q' x + rest| <= limit.
  void allow(double slope, double rest, double limit) {
    if (std::abs(slope) < 1e-12) return;
    const double a = (-limit - rest) / slope, b = (limit - rest) / slope;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
};

/// A stop from its begin to rest.
struct MinStop {
  double time_s = 0;
  double distance_mm = 0;  ///< of path length
};

/// How the greediest stop is walked.
struct GreedyWalk {
  double share = 1;  ///< of acceleration and jerk
  double step_s = 1e-4;
  double max_s = 20;  ///< where no braking is allowed it goes on for so long
};

/// The greediest stop: at every instant the hardest braking that the joints' acceleration and jerk
/// allow just there, let go in time to land. It looks no way ahead, so where limits get tighter it
/// breaks them: AttainableStop (attainable_stop.hpp) finds a stop that does not. On a straight
/// cruise it is the exact optimum but for its step. `joints_at(s)` are the joints along the path,
/// in jets; `visit` gets every state before the last one.
template <class JointsAt, class Visit>
[[nodiscard]] MinStop walk_greedily(const MachineModel& machine, PathState state,
                                    JointsAt&& joints_at, const GreedyWalk& walk, Visit&& visit) {
  const double begin = state.s, step_s = walk.step_s;
  double time = 0;
  while (state.ds > 1e-9 && time < walk.max_s) {
    const Joints<Jet<3>> q = joints_at(state.s);
    Interval accel, jerk;
    for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
      const JointLimits& limits = machine.joints[i].limits;
      const double d1 = q[i].derivative(1), d2 = q[i].derivative(2), d3 = q[i].derivative(3),
                   v = state.ds;
      accel.allow(d1, d2 * v * v, walk.share * limits.acceleration);
      jerk.allow(d1, 3 * d2 * v * state.dds + d3 * v * v * v, walk.share * limits.jerk);
    }
    visit(state);
    const double a = state.dds;
    const double rising = std::max(jerk.high, 1e-6);
    const bool must_let_go = a < 0 && state.ds <= a * a / (2 * rising);
    if (must_let_go) {  // constant jerk to rest
      const double left = -2 * state.ds / a;
      return {time + left, state.s - begin + state.ds * left / 3};
    }
    double j = std::max(jerk.low, (accel.low - a) / step_s);
    j = std::min(j, rising);
    state.s += step_s * (state.ds + step_s * (a / 2 + step_s * j / 6));
    state.ds += step_s * (a + step_s * j / 2);
    state.dds += step_s * j;
    time += step_s;
  }
  return {time, state.s - begin};
}

/// Time and length of the greediest stop.
template <class JointsAt>
[[nodiscard]] MinStop min_stop(const MachineModel& machine, const PathState& state,
                               JointsAt&& joints_at) {
  return walk_greedily(machine, state, joints_at, {}, [](const PathState&) {});
}

/// Time of the greediest stop on one path piece.
inline double min_stopping_time(const MachineModel& machine, const PathPiece& path,
                                const PathState& state, const JointVector& joints) {
  JointVector reference = joints;
  const auto along = [&](double s) {
    const auto at = Jet<3>::variable(std::min(s, path.length));
    const Joints<Jet<3>> q = joints_at(machine, path, at, reference).q;
    for (std::size_t i = 0; i < q.size(); ++i) reference[i] = value_of(q[i]);
    return q;
  };
  return min_stop(machine, state, along).time_s;
}

}  // namespace meridian::test
