// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/route/route_look_ahead.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"
#include "service/core/planner/singular/pole/pole_corridor.hpp"

/// What blocks behind the spans tell of a core. Part of PoleCorridor.
///
///     ─ zone ─ core ─ zone ─┬─ exact, on spans ─┬─ programmed blocks ─▶ as far as a route carries
///                           └ within reach      └ known_end: here the routes start
namespace meridian {
namespace {

constexpr std::size_t kMaxCandidates = RouteLookAhead::kMaxCandidates;

}  // namespace

bool PoleCorridor::foresee(PolePass& pass) noexcept {
  pass.ahead = {};
  if (look_ahead_ == nullptr || pass.at_end != PoleJoin::kExact) return true;
  if (asked_u_ != pass.known_end) {
    if (returns_to_pole(pass)) return true;
    ask(pass);
    asked_u_ = pass.known_end;
  }
  if (!look_ahead_->look()) return false;
  const auto routes = look_ahead_->routes();
  const auto carries_as_first = [&](const RouteAhead& route) {
    return route.carries == routes.front().carries;
  };
  if (!std::all_of(routes.begin(), routes.end(), carries_as_first)) pass.ahead = routes;
  return true;
}

/// Whether another zone decides before the routes start.
bool PoleCorridor::returns_to_pole(const PolePass& pass) const noexcept {
  const double begin = pass.end;
  for (PoleProbes::ProbeIndex n = probes_.end_probe() - 1; n >= probes_.begin_probe(); --n) {
    const double u = probes_.u_of(n);
    if (u <= begin) return false;
    if (u <= pass.known_end && probes_.distance_of(n) < kOtherTolerances * tolerance_rad_)
      return true;
  }
  return false;
}

void PoleCorridor::ask(const PolePass& pass) noexcept {
  const BandSpan& span = probes_.span_at(pass.known_end);
  const ToolPose pose = pose_on(span.c, std::clamp(pass.known_end - span.u0, 0.0, span.length));
  const int free = redundant_joint(model_);
  const JointLimits& limits = model_.joints[free].limits;
  std::array<RouteAhead, kMaxCandidates> routes;
  std::size_t count = 0;
  const auto add = [&](int branch, JointVector at, double value) {
    at[free] = value;
    if (count == kMaxCandidates || first_joint_outside_travel(model_, at, kTravelMargin) >= 0)
      return;
    routes[count] = {};
    routes[count].branch = branch;
    routes[count++].free = value;
  };
  for (int branch = 0; branch < branch_count(model_); ++branch) {
    const auto at = solve(model_, tool_length_mm_, pose, branch, known_);
    if (at.status == SolveStatus::kUnreachable) continue;
    if (model_.joints[free].is_endless) {
      add(branch, at.q, at.q[free]);
      continue;
    }
    double value = at.q[free];
    while (value - kTurn_rad >= limits.travel_min) value -= kTurn_rad;
    for (; value <= limits.travel_max; value += kTurn_rad) add(branch, at.q, value);
  }
  look_ahead_->ask({span.sequence, true, pose, tool_length_mm_}, {routes.data(), count});
}

}  // namespace meridian
