// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/joint_cells.hpp"
#include "service/core/planner/route/ahead_look.hpp"
#include "service/core/planner/singular/pole_bounds.hpp"
#include "service/core/planner/singular/pole_corridor.hpp"

/// What blocks behind the spans tell of a core. Part of PoleCorridor.
///
///     ─ zone ─ core ─ zone ─┬─ exact, on spans ─┬─ programmed blocks ─▶ as far as a way carries
///                           └ within reach      └ known_end: here the ways start
namespace meridian {
namespace {

constexpr std::size_t kMaxWays = AheadLook::kMaxWays;

}  // namespace

bool PoleCorridor::foresee(PolePlace& place) noexcept {
  place.ahead = {};
  if (look_ahead_ == nullptr || place.at_end != PoleJoin::kExact) return true;
  if (asked_u_ != place.known_end) {
    if (returns_to_pole(place)) return true;
    ask(place);
    asked_u_ = place.known_end;
  }
  if (!look_ahead_->look()) return false;
  const auto ways = look_ahead_->ways();
  const auto carries_as_first = [&](const AheadWay& way) {
    return way.carries == ways.front().carries;
  };
  if (!std::all_of(ways.begin(), ways.end(), carries_as_first)) place.ahead = ways;
  return true;
}

/// Whether another zone decides before the ways start.
bool PoleCorridor::returns_to_pole(const PolePlace& place) const noexcept {
  const double begin = place.end;
  for (PoleProbes::Place n = probes_.end_place() - 1; n >= probes_.begin_place(); --n) {
    const double u = probes_.u_of(n);
    if (u <= begin) return false;
    if (u <= place.known_end && probes_.distance_of(n) < kOtherTolerances * tolerance_rad_)
      return true;
  }
  return false;
}

void PoleCorridor::ask(const PolePlace& place) noexcept {
  const BandSpan& span = probes_.span_at(place.known_end);
  const ToolPose pose = pose_on(span.c, std::clamp(place.known_end - span.u0, 0.0, span.length));
  const int free = redundant_joint(model_);
  const JointLimits& limits = model_.joints[free].limits;
  std::array<AheadWay, kMaxWays> ways;
  std::size_t count = 0;
  const auto add = [&](int branch, JointVector at, double value) {
    at[free] = value;
    if (count == kMaxWays || first_joint_outside_travel(model_, at, kTravelMargin) >= 0) return;
    ways[count] = {};
    ways[count].branch = branch;
    ways[count++].free = value;
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
  look_ahead_->ask({span.sequence, true, pose, tool_length_mm_}, {ways.data(), count});
}

}  // namespace meridian
