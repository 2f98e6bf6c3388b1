// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "meridian/planner/smooth_planner.hpp"
#include "property/planner/plan_trace.hpp"

/// Smooth programs through the real port, read as the cycle reads it.
namespace meridian::test {

/// Reads the port and stops before every tail that no window follows, unless told to run it.
class PatientReader {
 public:
  explicit PatientReader(MotionPort& port) : reader_(port) {}

  /// Reads on into `trace`; `runs_dry` lets the machine enter a tail.
  void read(Trace& trace, bool runs_dry) {
    while (runs_dry || !is_before_tail()) {
      const TimePiece* piece = reader_.advance();
      if (piece == nullptr) return;
      if (piece->is_tail) ++tails_;
      trace.times.push_back(*piece);
      trace.paths.push_back(reader_.path() != nullptr ? *reader_.path() : PathPiece{});
    }
  }
  [[nodiscard]] int tails() const { return tails_; }

 private:
  [[nodiscard]] bool is_before_tail() {
    const TimePiece* next = reader_.look_ahead(1);
    if (next == nullptr) return true;
    if (!next->is_tail || (reader_.piece() != nullptr && reader_.piece()->is_tail)) return false;
    for (std::size_t i = 2;; ++i) {
      const TimePiece* later = reader_.look_ahead(i);
      if (later == nullptr) return true;
      if (later->window != next->window) return later->is_from_rest;
    }
  }

  MotionReader reader_;
  int tails_ = 0;
};

struct SmoothTrace : Trace {
  int tails = 0;  ///< pieces of tails that were run
  std::vector<RelaxedAxis> relaxed_axes;
  std::vector<Rewind> rewinds;
};

/// Plans `blocks` from `start`; `reads(n)` tells whether the port is read after block n, `dry(n)`
/// whether the machine then runs into the tail; `looks`: whether the begin of the program is looked
/// at before it is planned.
template <class Reads, class Dry>
SmoothTrace plan_smooth(const MachineModel& model, const std::vector<ClBlock>& blocks,
                        const JointVector& start, const SmoothSettings& settings, Reads reads,
                        Dry dry, bool looks = false) {
  SmoothTrace trace;
  SmoothPlanner planner(model);
  planner.begin(start, model.tool_length_mm, 0, settings);
  if (!looks) planner.look_no_further();
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  PatientReader reader(*port);
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    for (int tries = 0; tries < 100000; ++tries) {
      trace.last = planner.plan(blocks[n], writer);
      if (trace.last.status != PlanStatus::kNoRoom) break;
      reader.read(trace, false);
    }
    for (RelaxedAxis relaxed_axis; planner.take_relaxed_axis(relaxed_axis);)
      trace.relaxed_axes.push_back(relaxed_axis);
    for (Rewind one; planner.take_rewind(one);) trace.rewinds.push_back(one);
    if (trace.last.status != PlanStatus::kOk) break;
    if (reads(n)) reader.read(trace, dry(n));
  }
  reader.read(trace, true);
  trace.tails = reader.tails();
  trace.joints = planner.joints();
  return trace;
}

inline SmoothTrace plan_smooth(const MachineModel& model, const std::vector<ClBlock>& blocks,
                               const JointVector& start,
                               const SmoothSettings& settings = {Transition::kSmooth, 0, 0},
                               bool looks = false) {
  return plan_smooth(
      model, blocks, start, settings, [](std::size_t) { return true; },
      [](std::size_t) { return false; }, looks);
}

/// Bits of what the cycle would run.
[[nodiscard]] inline bool are_same(const SmoothTrace& a, const SmoothTrace& b) {
  if (a.times.size() != b.times.size()) return false;
  for (std::size_t n = 0; n < a.times.size(); ++n) {
    const TimePiece &x = a.times[n], &y = b.times[n];
    const PathPiece &p = a.paths[n], &q = b.paths[n];
    const bool is_same_time = x.sequence == y.sequence && x.duration == y.duration &&
                              x.s0 == y.s0 && x.v == y.v && x.a == y.a && x.j == y.j &&
                              x.k == y.k && x.path_index == y.path_index;
    if (!is_same_time || p.motion != q.motion || p.joints_begin != q.joints_begin ||
        p.joints_end != q.joints_end || p.spline != q.spline || p.free_quintic != q.free_quintic) {
      return false;
    }
  }
  return true;
}

/// Joints of the first block on some branch, the machine's start where no approach is wanted.
inline JointVector joints_of(const MachineModel& model, const ClBlock& block) {
  const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis).normalized()};
  JointVector start{};
  for (int branch = 0; branch < branch_count(model); ++branch) {
    const auto at = solve(model, model.tool_length_mm, pose, branch, JointVector{});
    if (at.status != SolveStatus::kUnreachable && first_joint_outside_travel(model, at.q, 0) < 0) {
      return at.q;
    }
  }
  return start;
}

/// Matched distance, in tolerances, of `pose` from the programmed ways about block `sequence`: the
/// least over poses of the path of the larger of tip and axis.
inline double distance_from(const std::vector<PathPiece>& programmed, std::uint64_t sequence,
                            const ToolPose& pose, double tip_mm, double axis_rad,
                            double enough = 0) {
  constexpr double kBehind_mm = 0.3, kAhead_mm = 2.5;  // a span is named by where it begins
  const auto min_on = [&](const PathPiece& programmed_path) {
    const auto at = [&](double x) {
      const ToolPose p = pose_at(programmed_path, x * programmed_path.length);
      return std::max((p.tip - pose.tip).norm() / tip_mm,
                      angle_between(p.axis, pose.axis) / axis_rad);
    };
    double low = 0, high = 1;
    for (int n = 0; n < 40; ++n) {
      const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
      (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
    }
    return std::min({at(0.5 * (low + high)), at(0.0), at(1.0)});
  };
  double smallest = min_on(programmed[sequence]);
  double length = 0;
  for (std::size_t n = sequence; n-- > 0 && length < kBehind_mm; length += programmed[n].length) {
    if (smallest <= enough) return smallest;
    if (programmed[n].length > 0) smallest = std::min(smallest, min_on(programmed[n]));
  }
  length = 0;
  for (std::size_t n = sequence + 1; n < programmed.size() && length < kAhead_mm; ++n) {
    if (smallest <= enough) return smallest;
    if (programmed[n].length > 0) smallest = std::min(smallest, min_on(programmed[n]));
    length += programmed[n].length;
  }
  return smallest;
}

}  // namespace meridian::test
