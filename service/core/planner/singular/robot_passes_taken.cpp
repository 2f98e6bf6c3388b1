// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/singular/pole_bounds.hpp"
#include "service/core/planner/singular/pole_time.hpp"
#include "service/core/planner/singular/robot_passes.hpp"

/// Which passes a robot takes: of one singular place or of both. Part of RobotPasses.
namespace meridian {
namespace {

/// Nearer to the base axis than this the arm turns too much with the tool for a pass of the wrist
/// alone.
constexpr double kNearShoulder_mm = 200;
/// Nearer than this such a pass is narrow, if there is one.
constexpr double kBesideShoulder_mm = 30;
/// Nearer to each other than this, one place cannot be passed ahead of the other.
constexpr double kApart_mm = 1;
/// One after the other: of the yaw, of yaw and roll, and one to spare.
constexpr int kMaxTurnsAtRest = 3;
/// Of a tolerance, nearer than which a joint may rest in the singular place.
constexpr double kMayRestTolerances = 0.95;
constexpr double kNoDistance = std::numeric_limits<double>::infinity();

}  // namespace

std::optional<Singularity> RobotPasses::held_at() const noexcept {
  const bool wrist = is_held_[index_of(Singularity::kWrist)];
  const bool shoulder = is_held_[index_of(Singularity::kShoulder)];
  if (!wrist && !shoulder) return {};
  if (wrist && shoulder) return Singularity::kBoth;
  return wrist ? Singularity::kWrist : Singularity::kShoulder;
}

std::optional<double> RobotPasses::find_other(Singularity at, double from,
                                              double to) const noexcept {
  if (!has_wrist_roll(model_) || at == Singularity::kBoth) return {};
  const Singularity other = other_of(at);
  const double here = emitted_u();
  if (distance_at(other, here) < kOnPoleTolerances * tolerance(other)) return here;
  std::optional<double> nearest;
  const auto look_on = [&](int branch, double begin) {
    const auto distance = [&](std::int64_t probe) {
      return probe < end_probe() ? distance_at(other, u_of(probe), branch) : kNoDistance;
    };
    double before = kNoDistance;
    for (std::int64_t probe = probe_; probe < end_probe() && u_of(probe) <= to; ++probe) {
      const double there = distance(probe);
      const bool is_lowest = there <= before && there <= distance(probe + 1);
      before = there;
      if (!is_lowest) continue;
      const double u = refine_minimum(other, probe, branch);
      if (u < begin || !(distance_at(other, u, branch) < tolerance(other))) continue;
      nearest = std::min(u, nearest.value_or(u));
      return;
    }
  };
  look_on(branch_, here);
  if (at != Singularity::kShoulder || nearest) return nearest;
  look_on(branch_ ^ robot::kBack,
          from);  // behind the base axis the arm may stand on its other side
  return nearest ? nearest : find_wrist_straight_through(from, to);
}

/// With the yaw straight through the base axis about `from`, where the wrist comes into line.
std::optional<double> RobotPasses::find_wrist_straight_through(double from,
                                                               double to) const noexcept {
  constexpr int kSteps = 40, kRounds = 40;
  constexpr double kGolden = 0.3819660112501051;
  const double begin = std::max(emitted_u(), from - kPassReach_mm);
  const double end = std::min(to, end_u());
  const double yaw = follow_to(begin)[robot::kYaw];
  const auto distance = [&](double u) {
    const ToolPose pose = pose_in_machine(model_, pose_of<double>(span_at(u), u));
    return robot::wrist_distance_at_yaw(model_.robot, tool_length_mm_, pose, branch_, yaw);
  };
  int nearest = 0;
  const auto u_at = [&](int k) { return begin + (end - begin) * k / kSteps; };
  for (int k = 1; k <= kSteps; ++k) {
    if (distance(u_at(k)) < distance(u_at(nearest))) nearest = k;
  }
  double low = u_at(std::max(nearest - 1, 0)), high = u_at(std::min(nearest + 1, kSteps));
  for (int n = 0; n < kRounds; ++n) {
    const double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
    (distance(a) <= distance(b) ? high : low) = distance(a) <= distance(b) ? b : a;
  }
  const double u = 0.5 * (low + high);
  return distance(u) < tolerance(Singularity::kWrist) ? std::optional(u) : std::nullopt;
}

bool RobotPasses::settle(Singularity at, double nearest) noexcept {
  const double end = end_u();
  if (end < nearest + kPassReach_mm && !is_finished_ && !spans_.is_full()) return false;
  const auto other = find_other(at, nearest, nearest + kPassReach_mm);
  const double last = std::max(nearest, other.value_or(nearest));
  if (end < last + kPassReach_mm && !is_finished_ && !spans_.is_full()) return false;
  const double first = std::min(nearest, other.value_or(nearest));
  PlaceOfPass both{first, last};
  if (other && try_pass(Singularity::kBoth, both)) return true;
  PlaceOfPass alone{nearest, nearest};
  const double off_base = distance_at(Singularity::kShoulder, nearest);
  const bool is_wrist_alone = at == Singularity::kWrist && has_wrist_roll(model_) && !other;
  if (is_wrist_alone && off_base < kBesideShoulder_mm && try_pass(Singularity::kBoth, alone)) {
    return true;
  }
  if (other && *other > nearest + kApart_mm) {
    PlaceOfPass ahead = alone;
    ahead.limit = 0.5 * (nearest + *other);
    if (try_pass(at, ahead)) return true;
  }
  if (try_pass(at, alone)) return true;
  both.may_be_narrow = true;
  if (other && try_pass(Singularity::kBoth, both)) return true;
  const bool is_near_shoulder = off_base >= kBesideShoulder_mm && off_base < kNearShoulder_mm;
  if (is_wrist_alone && is_near_shoulder) (void)try_pass(Singularity::kBoth, alone);
  if (!has_pass_) is_held_ = {};
  return true;
}

bool RobotPasses::try_pass(Singularity at, const PlaceOfPass& place) noexcept {
  // Inside the tolerance a joint may rest, but closely beside the singular place it has to.
  return try_resting(at, place, kOnPoleTolerances) || try_resting(at, place, kMayRestTolerances);
}

bool RobotPasses::try_resting(Singularity at, const PlaceOfPass& place,
                              double tolerances) noexcept {
  PassRange range;
  range.at = at;
  range.nearest = place.nearest;
  range.last_nearest = place.last_nearest;
  range.from = held_at() ? emitted_u() : std::max(emitted_u(), place.nearest - kPassReach_mm);
  range.to = std::min({place.last_nearest + kPassReach_mm, place.limit, end_u()});
  bool rests = false;
  for (const Singularity one : kSingularPlaces) {
    const auto is_within = [&](double u, double share) {
      return distance_at(one, u) < share * tolerance(one);
    };
    const bool ends_at_rest = is_within(range.to, tolerances);
    // Where the path leads off from rest, any joint inside the tolerance will do to begin with.
    const double may_rest =
        is_within(range.to, kMayRestTolerances) ? tolerances : kMayRestTolerances;
    const bool begins_at_rest =
        is_held_[index_of(one)] || (range.from <= 0 && is_within(range.from, may_rest));
    rests |= (begins_at_rest || ends_at_rest) && drives(at, one);
    range.ends[index_of(one)] = {begins_at_rest ? PassEnd::kAtRest : PassEnd::kOnPath,
                                 ends_at_rest ? PassEnd::kAtRest : PassEnd::kOnPath};
  }
  if (tolerances > kOnPoleTolerances && !rests) return false;  // as before
  // With the roll at rest, and the path too, the yaw needs no slope: the tip may give.
  const PassEnds& roll = range.ends[index_of(Singularity::kWrist)];
  PassEnds& yaw = range.ends[index_of(Singularity::kShoulder)];
  if (at == Singularity::kBoth && range.from <= 0 && roll.from == PassEnd::kAtRest) {
    yaw.from = PassEnd::kAtRest;
  }
  if (at == Singularity::kBoth && is_finished_ && !(range.to < end_u()) &&
      roll.to == PassEnd::kAtRest) {
    yaw.to = PassEnd::kAtRest;
  }
  range.may_turn = turns_ < kMaxTurnsAtRest;
  range.may_be_narrow = place.may_be_narrow;
  range.branch = branch_;
  range.joints = follow_to(range.from);
  const PassTask task{
      model_,   *this, axes_, tips_, tool_length_mm_, axis_tolerance_rad_, tip_tolerance_mm_,
      is_exact_};
  const RobotPass pass = find_robot_pass(task, range);
  if (!(pass.end > pass.begin)) return false;
  pass_ = pass;
  at_ = at;
  has_pass_ = true;
  is_held_ = pass.rests;
  turns_ = pass.is_turned ? turns_ + 1 : 0;
  while (probe_ < end_probe() && u_of(probe_) <= pass_.end) ++probe_;
  if (at != Singularity::kBoth && place.limit < place.last_nearest + kPassReach_mm) --probe_;
  return true;
}

}  // namespace meridian
