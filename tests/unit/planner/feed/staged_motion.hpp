// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "meridian/cycle/stop/stop_margin.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "service/core/planner/feed/legs/leg.hpp"
#include "service/core/planner/route/staging.hpp"

/// What was staged, checked by the derivatives of the joints alone.
namespace meridian::test {

/// Largest shares of the joints' limits.
struct JointUse {
  double velocity = 0, acceleration = 0, jerk = 0;
  [[nodiscard]] double worst() const { return std::max({velocity, acceleration, jerk}); }
  void take(const JointUse& other) {
    velocity = std::max(velocity, other.velocity);
    acceleration = std::max(acceleration, other.acceleration);
    jerk = std::max(jerk, other.jerk);
  }
};

/// The use by `state` on `path`, of the limits of a hold or a FaultStop.
inline JointUse use_at(const MachineModel& model, const PathPiece& path, const PathState& state,
                       const JointVector& reference, bool is_fault_stop = false) {
  const auto at = joints_at(model, path, Jet<3>::variable(state.s), reference);
  EXPECT_NE(at.status, SolveStatus::kUnreachable);
  const Limited<Jet<3>> q = limited_of(model, at.q);
  JointUse use;
  for (int i = 0; i < limited_count(model); ++i) {
    const JointLimits& limits = limited_spec(model, i).limits;
    const double d1 = q[i].derivative(1), d2 = q[i].derivative(2), d3 = q[i].derivative(3);
    const double v = state.ds, a = state.dds, j = state.ddds;
    use.take({std::abs(d1 * v) / limits.velocity,
              std::abs(d2 * v * v + d1 * a) /
                  (is_fault_stop ? limits.fault_acceleration : limits.acceleration),
              std::abs(d3 * v * v * v + 3 * d2 * v * a + d1 * j) /
                  (is_fault_stop ? limits.fault_jerk : limits.jerk)});
  }
  return use;
}

inline JointVector joints_near(const MachineModel& model, const PathPiece& path, double s) {
  JointVector q = path.joints_begin;
  for (int n = 0; n <= 4; ++n) q = joints_at(model, path, s * n / 4, q).q;
  return q;
}

/// The use by the whole of `staged`, whose pieces are to follow one another from rest to rest.
inline JointUse use_of_motion(const MachineModel& model, const Staging& staged) {
  JointUse use;
  PathState last{0, 0, 0, 0};
  std::uint64_t on = staged.first_index;
  for (int n = 0; n < staged.time_count; ++n) {
    const TimePiece& time = staged.times[n];
    const PathPiece& path = staged.paths[time.path_index - staged.first_index];
    const PathState begin = state_at(time, 0);
    if (time.path_index != on) {
      EXPECT_NEAR(last.s, staged.paths[on - staged.first_index].length, 1e-9) << n;
      last = {0, 0, 0, 0};
      EXPECT_EQ(time.path_index, on + 1) << n;
      on = time.path_index;
    }
    EXPECT_NEAR(begin.s, last.s, 1e-9 * (1 + last.s)) << n;
    EXPECT_NEAR(begin.ds, last.ds, 1e-6 * (1 + last.ds)) << n;
    for (int k = 0; k <= 4; ++k) {
      const PathState state = state_at(time, time.duration * k / 4);
      use.take(use_at(model, path, state, joints_near(model, path, state.s)));
    }
    last = state_at(time, time.duration);
  }
  EXPECT_NEAR(last.ds, 0, 1e-6);
  EXPECT_NEAR(last.s, staged.paths[on - staged.first_index].length, 1e-9);
  return use;
}

/// The use by holds or FaultStops that start all along `staged`, at sixty times or more, with all
/// that they may use.
inline JointUse use_of_stops(const MachineModel& model, const Staging& staged, bool is_fault_stop) {
  JointUse use;
  for (int n = 0; n < staged.time_count; n += 1 + staged.time_count / 60) {
    const TimePiece& time = staged.times[n];
    const PathPiece& path = staged.paths[time.path_index - staged.first_index];
    for (int k = 0; k <= 2; ++k) {
      const PathState begin = state_at(time, time.duration * k / 2);
      const auto kind = is_fault_stop ? StopKind::kFault : StopKind::kHold;
      const StopMargin margin = authority_of(time, kind, begin);
      if (!(margin.jerk > 0)) continue;
      const StopLaw law(begin, margin);
      for (int m = 0; m <= 12; ++m) {
        const PathState state = law.at(law.duration() * m / 12.001);
        EXPECT_LE(state.s, path.length + 1e-9) << n;
        const auto near = joints_near(model, path, state.s);
        use.take(use_at(model, path, state, near, is_fault_stop));
      }
    }
  }
  return use;
}

inline double duration_of(const Staging& staged) {
  double sum = 0;
  for (int n = 0; n < staged.time_count; ++n) sum += staged.times[n].duration;
  return sum;
}

/// Largest speed of the tip.
inline double tip_speed_of(const Staging& staged) {
  double largest = 0;
  for (int n = 0; n < staged.time_count; ++n) {
    const TimePiece& time = staged.times[n];
    const PathPiece& path = staged.paths[time.path_index - staged.first_index];
    for (int k = 0; k <= 10; ++k) {
      const PathState state = state_at(time, time.duration * k / 10);
      const auto tip = pose_at(path, Jet<1>::variable(state.s)).tip;
      double square = 0;
      for (int i = 0; i < 3; ++i) square += tip[i].derivative(1) * tip[i].derivative(1);
      largest = std::max(largest, std::sqrt(square) * state.ds);
    }
  }
  return largest;
}

}  // namespace meridian::test
