// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "meridian/planner/time_law.hpp"
#include "meridian/units.hpp"

/// Plans programs through the real port and checks what comes out of it, knowing nothing of how it
/// was planned.
namespace meridian::test {

/// What the port delivered, in order.
struct Trace {
  std::vector<TimePiece> times;
  std::vector<PathPiece> paths;  ///< of the time piece with the same index
  PlanResult last;
  double axis_deviation_rad = 0;
  JointVector joints{};
  [[nodiscard]] double duration_s() const {
    double sum = 0;
    for (const TimePiece& piece : times) sum += piece.duration;
    return sum;
  }
};

/// Whether the feed planner shaped a motion; constant bounds give its stops by velocity.
[[nodiscard]] inline bool is_by_feed_planner(const TimePiece& time) {
  return !(time.authority_velocity > 0);
}

/// Runs `blocks` through a planner, emptying the port as the cycle would.
inline Trace plan_program(RestToRestPlanner& planner, MotionPort& port,
                          const std::vector<ClBlock>& blocks) {
  Trace trace;
  MotionWriter writer(port);
  MotionReader reader(port);
  for (const ClBlock& block : blocks) {
    trace.last = planner.plan(block, writer);
    if (trace.last.status == PlanStatus::kRefused) break;
    trace.axis_deviation_rad = std::max(trace.axis_deviation_rad, trace.last.axis_deviation_rad);
    while (const TimePiece* piece = reader.advance()) {
      trace.times.push_back(*piece);
      trace.paths.push_back(reader.path() != nullptr ? *reader.path() : PathPiece{});
    }
  }
  trace.joints = planner.joints();
  return trace;
}

inline Trace plan_program(const MachineModel& model, const std::vector<ClBlock>& blocks,
                          const JointVector& start, const ToolTable& tools = {}) {
  RestToRestPlanner planner(model, tools);
  planner.begin(start, model.tool_length_mm, 0);
  const auto port = std::make_unique<MotionPort>();
  return plan_program(planner, *port, blocks);
}

/// One setpoint of a plan.
struct PlanSample {
  JointVector q{};
  int piece = 0;  ///< index into the trace
  double s = 0;
};

/// Setpoints every `cycle_s`, the first one `phase` cycles after the begin, three at rest either
/// side.
inline std::vector<PlanSample> sample(const MachineModel& model, const Trace& trace, double cycle_s,
                                      double phase, const JointVector& start) {
  std::vector<PlanSample> out(3, PlanSample{start, 0, 0});
  JointVector reference = start;
  double begin = 0;
  std::size_t count = 0;
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    const TimePiece& piece = trace.times[n];
    for (;; ++count) {
      const double t = (static_cast<double>(count) + phase) * cycle_s - begin;
      if (t >= piece.duration) break;
      PlanSample setpoint{reference, static_cast<int>(n), 0};
      if (piece.kind == TimeKind::kMove) {
        setpoint.s = state_at(piece, t).s;
        const auto at = joints_at(model, trace.paths[n], setpoint.s, reference);
        EXPECT_NE(at.status, SolveStatus::kUnreachable);
        setpoint.q = reference = at.q;
      }
      out.push_back(setpoint);
    }
    if (piece.kind == TimeKind::kMove) {
      const double end = state_at(piece, piece.duration).s;
      reference = joints_at(model, trace.paths[n], end, reference).q;
    }
    begin += piece.duration;
  }
  for (int n = 0; n < 3; ++n) {
    out.push_back({trace.joints, static_cast<int>(trace.times.size()) - 1, 0});
  }
  return out;
}

/// Largest use of velocity, acceleration and jerk limits of joints and drives by differences, what
/// rounding may add (8 ulp(q)/T^n) taken off: a value above 1 + 1e-6 breaks a limit.
struct LimitUse {
  double v = 0, a = 0, j = 0;
  std::string where;
};

inline LimitUse measure_limits(const MachineModel& model, const std::vector<PlanSample>& setpoints,
                               double cycle_s) {
  LimitUse use;
  std::vector<LimitedVector> at;
  for (const PlanSample& s : setpoints) at.push_back(limited_of(model, s.q));
  for (int i = 0; i < limited_count(model); ++i) {
    const JointLimits& limits = limited_spec(model, i).limits;
    double largest = 0;
    for (const LimitedVector& q : at) largest = std::max(largest, std::abs(q[i]));
    const double ulp = std::nextafter(largest, 1e300) - largest;
    const double t1 = cycle_s, t2 = t1 * t1, t3 = t2 * t1;
    for (std::size_t n = 3; n < setpoints.size(); ++n) {
      const double q0 = at[n - 3][i], q1 = at[n - 2][i], q2 = at[n - 1][i], q3 = at[n][i];
      const double v = (std::abs(q3 - q2) - 8 * ulp) / t1 / limits.velocity;
      const double a = (std::abs((q3 - q2) - (q2 - q1)) - 8 * ulp) / t2 / limits.acceleration;
      const double j =
          (std::abs((q3 - q2) - 2 * (q2 - q1) + (q1 - q0)) - 8 * ulp) / t3 / limits.jerk;
      if (std::max({v, a, j}) > std::max({use.v, use.a, use.j})) {
        use.where = "joint " + std::to_string(i) + " setpoint " + std::to_string(n) + " piece " +
                    std::to_string(setpoints[n].piece);
      }
      use.v = std::max(use.v, v);
      use.a = std::max(use.a, a);
      use.j = std::max(use.j, j);
    }
  }
  return use;
}

/// Largest distance of FK(joints) from the programmed way of its block, poses matched as the
/// recording check does: the programmed pose that minimises max(tip/1 µm, axis/0.001 deg).
struct Deviation {
  double tip_mm = 0;
  double axis_rad = 0;
};

inline Deviation match_pose(const PathPiece& programmed, const ToolPose& pose) {
  constexpr double kTip_mm = 1e-3;
  constexpr double kAxis_rad = 0.001 * units::kDegree_rad;
  const auto off = [&](double x) {
    const ToolPose at = pose_at(programmed, x * programmed.length);
    return Deviation{(at.tip - pose.tip).norm(), angle_between(at.axis, pose.axis)};
  };
  const auto measure = [&](double x) {
    const Deviation d = off(x);
    return std::max(d.tip_mm / kTip_mm, d.axis_rad / kAxis_rad);
  };
  double best = 0;
  for (int c = 1; c <= 40; ++c) {
    if (measure(c / 40.0) < measure(best)) best = c / 40.0;
  }
  double low = std::max(0.0, best - 0.025), high = std::min(1.0, best + 0.025);
  for (int c = 0; c < 50; ++c) {
    const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
    if (measure(a) < measure(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return off(0.5 * (low + high));
}

inline Deviation measure_deviation(const MachineModel& model, const Trace& trace,
                                   const std::vector<PlanSample>& setpoints,
                                   const std::vector<PathPiece>& programmed, int stride) {
  Deviation largest;
  for (std::size_t n = 3; n + 3 < setpoints.size(); n += static_cast<std::size_t>(stride)) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    if (trace.times[k].kind != TimeKind::kMove) continue;
    if (trace.paths[k].motion == MotionKind::kApproach) continue;
    const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
    const Deviation d = match_pose(programmed[trace.times[k].sequence], pose);
    largest.tip_mm = std::max(largest.tip_mm, d.tip_mm);
    largest.axis_rad = std::max(largest.axis_rad, d.axis_rad);
  }
  return largest;
}

/// The programmed way of every block, by sequence; the first motion block begins where it ends.
inline std::vector<PathPiece> programmed_paths(const std::vector<ClBlock>& blocks) {
  std::vector<PathPiece> out(blocks.size());
  ToolPose pose;
  bool is_first = true;
  for (const ClBlock& block : blocks) {
    if (!is_motion(block.kind)) continue;
    const ToolPose end{to_vector(block.tip_mm), to_vector(block.axis).normalized()};
    if (is_first) pose = {block.is_arc ? find_arc_begin(block) : end.tip, end.axis};
    is_first = false;
    out[block.sequence] = block.is_arc ? make_arc(pose, end, block) : make_line(pose, end);
    pose = end;
  }
  return out;
}

/// Largest tip speed over programmed feed.
inline double measure_feed(const MachineModel& model, const Trace& trace,
                           const std::vector<PlanSample>& setpoints, double cycle_s) {
  double largest = 0;
  for (std::size_t n = 4; n < setpoints.size(); ++n) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const auto k0 = static_cast<std::size_t>(setpoints[n - 1].piece);
    const TimePiece& now = trace.times[k];
    const TimePiece& before = trace.times[k0];
    if (now.kind != TimeKind::kMove || before.kind != TimeKind::kMove) continue;
    if (!(now.feed_mm_per_s > 0) || !(before.feed_mm_per_s > 0)) continue;
    const double feed = std::max(now.feed_mm_per_s, before.feed_mm_per_s);
    const Vector3 a = forward(model, trace.paths[k0].tool_length_mm, setpoints[n - 1].q).tip;
    const Vector3 b = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q).tip;
    constexpr double kRounding_mm = 1e-11;
    largest = std::max(largest, ((b - a).norm() - kRounding_mm) / cycle_s / feed);
  }
  return largest;
}

}  // namespace meridian::test
