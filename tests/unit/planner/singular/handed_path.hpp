// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/singular/pole/pole_corridor.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

/// Paths that are handed through a corridor, and how the joints follow what comes out.
namespace meridian::test::pole_corridor {

constexpr double kTolerance_rad = 0.1 * units::kDegree_rad;
constexpr double kTool_mm = 100;

/// A path that is handed through, some spans at a time.
class Handed {
 public:
  Handed(const MachineModel& m, std::vector<BandSpan> spans, int branch = 0)
      : model(m), path(std::move(spans)) {
    start.branch = branch;
    start.tool_length_mm = kTool_mm;
    start.tolerance_rad = kTolerance_rad;
    start.axis = pose_on(path[0].c, 0.0).axis;
    start.joints = solve(model, kTool_mm, pose_on(path[0].c, 0.0), branch, {}).q;
  }

  void run(int at_a_time = 1) {
    begin();
    for (std::size_t n = 0; n < path.size(); ++n) {
      push(n);
      if (static_cast<int>(n) % at_a_time == 0) read();
    }
    corridor.finish();
    read();
  }
  void begin() {
    corridor.begin(start);
    out.clear();
  }
  void push(std::size_t n) {
    corridor.mark(path[n].u0 + path[n].length, pose_on(path[n].c, path[n].length).axis);
    corridor.push(path[n]);
    farthest_held = std::max(farthest_held, path[n].u0 + path[n].length - end_of_out());
  }
  void read() {
    while (const JointSpan* span = corridor.next()) out.push_back(*span);
  }
  [[nodiscard]] double end_of_out() const {
    return out.empty() ? 0 : out.back().band.u0 + out.back().band.length;
  }
  [[nodiscard]] bool is_driven() const {
    return std::any_of(out.begin(), out.end(), [](const JointSpan& s) { return s.is_free_driven; });
  }

  MachineModel model;
  std::vector<BandSpan> path;
  PoleCorridor::Start start;
  PoleCorridor corridor{model};
  std::vector<JointSpan> out;
  double farthest_held = 0;
};

/// What comes out follows one another and is the path that went in.
inline void expect_whole(const Handed& handed) {
  double u = 0;
  for (const JointSpan& span : handed.out) {
    EXPECT_NEAR(span.band.u0, u, 1e-9);
    EXPECT_GT(span.band.length, 0);
    u = span.band.u0 + span.band.length;
    const BandSpan& whole = handed.path[static_cast<std::size_t>(span.band.u0 + 1e-9)];
    EXPECT_EQ(span.band.sequence, whole.sequence);
    EXPECT_EQ(span.band.line, whole.line);
    for (const double share : {0.0, 0.5, 1.0}) {
      const double at = span.band.u0 + share * span.band.length;
      const ToolPose got = pose_on(span.band.c, share * span.band.length);
      const ToolPose wanted = pose_on(whole.c, at - whole.u0);
      EXPECT_NEAR((got.tip - wanted.tip).norm(), 0, 1e-9) << at;
      EXPECT_NEAR((got.axis - wanted.axis).norm(), 0, 1e-9) << at;
    }
  }
  EXPECT_NEAR(u, static_cast<double>(handed.path.size()), 1e-9);
}

/// How the joints follow what came out.
struct FollowedPath {
  double turn = 0;          ///< of the redundant joint, all of it
  double farthest_rad = 0;  ///< of the axis from the path
  double jump = 0;          ///< of a joint between two spans
  double jump_d1 = 0;       ///< of the redundant joint's derivative, as a share of the largest
  JointVector end{};
};

inline FollowedPath follow(const MachineModel& model, JointVector q,
                           std::span<const JointSpan> spans) {
  FollowedPath followed;
  Joints<Jet<2>> last{};
  double max_d1 = 1e-3, jump_d1 = 0;
  bool is_first = true;
  for (const JointSpan& span : spans) {
    PathPiece piece = make_spline(span);
    piece.tool_length_mm = kTool_mm;
    for (int k = 0; k <= 16; ++k) {
      const double x = span.band.length * k / 16;
      const auto at = joints_at(model, piece, Jet<2>::variable(x), q);
      EXPECT_NE(at.status, SolveStatus::kUnreachable);
      for (int i = 0; i < 5; ++i) {
        const double by = value_of(at.q[i]) - q[i];
        if (k == 0) followed.jump = std::max(followed.jump, std::abs(by));
        if (i == 3) followed.turn += std::abs(by);
        EXPECT_LT(std::abs(by), i < 3 ? 40 : 0.6) << "u " << span.band.u0 + x << " joint " << i;
        max_d1 = std::max(max_d1, std::abs(at.q[i].derivative(1)));
        if (k == 0 && i == 3 && !is_first) {
          jump_d1 = std::max(jump_d1, std::abs(at.q[i].derivative(1) - last[i].derivative(1)));
        }
        q[i] = value_of(at.q[i]);
      }
      last = at.q;
      is_first = false;
      const Vector3 axis = forward(model, kTool_mm, q).axis;
      followed.farthest_rad =
          std::max(followed.farthest_rad, angle_between(axis, pose_on(span.band.c, x).axis));
    }
  }
  followed.jump_d1 = jump_d1 / max_d1;
  followed.end = q;
  return followed;
}

inline FollowedPath follow(const Handed& handed) {
  return follow(handed.model, handed.start.joints, handed.out);
}

/// Past the pole, `beside` off it, at u = 60.
inline auto passing(double beside) {
  return [beside](double u) { return Lean{0.004 * (u - 60), beside}; };
}

}  // namespace meridian::test::pole_corridor
