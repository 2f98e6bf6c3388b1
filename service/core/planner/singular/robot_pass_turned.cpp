// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/joint_cells.hpp"
#include "service/core/planner/singular/robot_pass_search.hpp"

/// Joints that are turned next to standstill in the singular place. Part of RobotPassSearch.
namespace meridian {
namespace {

constexpr int kRestTurns = 12;  // to each side, of a joint that is to rest elsewhere
constexpr double kRestTurn_rad = std::numbers::pi / kRestTurns;
constexpr double kSameRest_rad = 1e-3, kMaxLeft_rad = 0.01;
constexpr double kQuarterTurn_rad = 0.5 * std::numbers::pi;
constexpr double kInLineTolerances = 0.3;  // the roll does not whirl yet, and may be driven

}  // namespace

RobotPass RobotPassSearch::search_turned() noexcept {
  constexpr double kShares[] = {1, 0.3, 0.1, 0.03, 0.01};
  RobotPass best;
  double best_time = kNever;
  for (const Singularity at : kSingularPlaces) {
    if (!drives(range_.at, at) || comes_out(at)) continue;
    for (const double share : kShares) {
      for (int n = 0; n < 2 * kRestTurns; ++n) {
        turned_ = {};
        turned_[index_of(at)] = (n % 2 == 0 ? 1 : -1) * kRestTurn_rad * (1 + n / 2);
        RobotPass pass = pass_over(range_.nearest - range_.from);
        pass.end = range_.last_nearest + share * (range_.to - range_.last_nearest);
        if (!fit(pass) || !is_inside(pass, kFirstSamples)) continue;
        const double time = time_on(pass);
        if (!(time < best_time) || !is_inside(pass, kSamples) || !is_inside_at_kinks(pass))
          continue;
        if (!rests_on(pass)) continue;
        best_time = time;
        best = pass;
      }
      if (is_pass(best)) break;
    }
  }
  turned_ = {};
  return best;
}

RobotPass RobotPassSearch::search_turned_off() noexcept {
  if (!range_.may_turn) return {};
  const auto turns = [&](Singularity at) { return !drives(range_.at, at) || comes_out(at); };
  if (!rests_at(&PassEnds::from) || !turns(Singularity::kWrist) || !turns(Singularity::kShoulder)) {
    return {};
  }
  const bool is_both = range_.at == Singularity::kBoth;
  if (is_both && !is_in_line(range_.joints[robot::kYaw], task_.axis_tolerance_rad)) return {};
  const Turns all = turns_off();
  for (std::size_t n = 0; n < all.count; ++n) {
    const Turned& by = all.by[n];
    for (const double part : {1.0, 0.97, 0.9, 0.8}) {  // another joint may be at its end there
      if ((1 - part) * largest_of(by) > kMaxLeft_rad) break;
      const RobotPass pass = turned_off({part * by[0], part * by[1]});
      if (is_pass(pass) && (!is_both || is_led_out(pass))) return pass;
    }
  }
  return {};
}

RobotPass RobotPassSearch::turned_off(const Turned& turned) noexcept {
  constexpr double kShares[] = {0.1, 0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4};
  const auto ends = range_.ends;
  RobotPass found;
  turned_ = turned;
  for (PassEnds& one : range_.ends) one.to = PassEnd::kAtRest;
  for (const double share : kShares) {
    RobotPass pass = pass_over(0);
    pass.end = range_.from + share * (range_.to - range_.from);
    if (!fit(pass) || !is_inside(pass, kSamples) || !is_inside_at_kinks(pass)) continue;
    found = pass;
    found.is_turned = true;
    break;
  }
  range_.ends = ends;
  turned_ = {};
  return found;
}

bool RobotPassSearch::is_led_out(const RobotPass& pass) const noexcept {
  PassRange behind = range_;
  behind.from = behind.nearest = behind.last_nearest = pass.end;
  for (PassEnds& one : behind.ends) one.from = PassEnd::kAtRest;
  behind.joints[robot::kYaw] = pass.joint.back();
  behind.joints[robot::kRoll] = pass.roll.back();
  RobotPassSearch next(task_, behind);
  const RobotPass out = next.search();
  return is_pass(out) && !next.is_narrow(out);
}

/// To where they are at the end of the range, on any branch, and with the yaw straight there; and
/// to where they are at its begin, the roll with the yaw that it has.
RobotPassSearch::Turns RobotPassSearch::turns_off() const noexcept {
  const ToolPose end = pose_of<double>(task_.spans.span_at(range_.to), range_.to);
  Turns turns;
  for (const int over : {0, robot::kBack, robot::kFlip, robot::kBack | robot::kFlip}) {
    const bool is_other =
        (drives_yaw_ || (over & robot::kBack) == 0) && (drives_roll_ || (over & robot::kFlip) == 0);
    if (!is_other) continue;
    auto there = solve(task_.model, task_.tool_length_mm, end, range_.branch ^ over, range_.joints);
    if (there.status != SolveStatus::kOk) continue;
    add_turn(there.q, turns);
    if (!drives_yaw_) continue;
    there.q[robot::kYaw] = straight_yaw(there.q[robot::kYaw]);
    add_turn(there.q, turns);
  }
  const ToolPose begin = pose_of<double>(task_.spans.span_at(range_.from), range_.from);
  if (range_.at == Singularity::kBoth) {
    const auto here =
        solve_driven(task_.model, task_.tool_length_mm, begin, range_.joints[robot::kYaw],
                     driven_branch(Singularity::kShoulder, range_.branch), range_.joints);
    if (here.status == SolveStatus::kOk) add_turn(here.q, turns);
  } else {
    const auto here = solve(task_.model, task_.tool_length_mm, begin, range_.branch, range_.joints);
    if (here.status == SolveStatus::kOk) add_turn(here.q, turns);
  }
  std::sort(turns.by.begin(), turns.by.begin() + static_cast<std::ptrdiff_t>(turns.count),
            [](const Turned& a, const Turned& b) { return largest_of(a) < largest_of(b); });
  return turns;
}

void RobotPassSearch::add_turn(const JointVector& there, Turns& turns) const noexcept {
  Turned by{};
  double largest = 0;
  for (const Singularity at : kSingularPlaces) {
    if (!drives(range_.at, at)) continue;
    const std::size_t joint = joint_of(at);
    const double stands = range_.joints[joint];
    double& turn = by[index_of(at)];
    turn = inside_travel(joint, unwind(there[joint], stands)) - stands;
    largest = std::max(largest, std::abs(turn));
  }
  if (range_.at == Singularity::kShoulder) {
    double& yaw = by[index_of(Singularity::kShoulder)];
    yaw = stopped_in_line(yaw);
    largest = std::abs(yaw);
  }
  if (largest > kSameRest_rad) turns.by[turns.count++] = by;
}

double RobotPassSearch::straight_yaw(double yaw) const noexcept {
  const auto wrist = [&](double u) {
    const ToolPose pose = pose_of<double>(task_.spans.span_at(u), u);
    return robot::wrist_point<double>(task_.model.robot, task_.tool_length_mm,
                                      pose_in_machine(task_.model, pose));
  };
  const auto from = wrist(range_.from), to = wrist(range_.to);
  const double along = unwind(std::atan2(to[1] - from[1], to[0] - from[0]), yaw);
  const double by = along - yaw;
  return std::abs(by) < kQuarterTurn_rad ? along : along - std::copysign(std::numbers::pi, by);
}

bool RobotPassSearch::is_in_line(double yaw, double within_rad) const noexcept {
  const ToolPose pose =
      pose_in_machine(task_.model, pose_of<double>(task_.spans.span_at(range_.from), range_.from));
  return robot::wrist_distance_at_yaw(task_.model.robot, task_.tool_length_mm, pose, range_.branch,
                                      yaw) < within_rad;
}

double RobotPassSearch::stopped_in_line(double by) const noexcept {
  if (!has_wrist_roll(task_.model)) return by;
  constexpr int kRounds = 30;
  const double stands = range_.joints[robot::kYaw];
  const double enough = kInLineTolerances * task_.axis_tolerance_rad;
  if (!is_in_line(stands + by, enough) || is_in_line(stands, enough)) return by;
  double outside = 0, inside = by;
  for (int n = 0; n < kRounds; ++n) {
    const double middle = 0.5 * (outside + inside);
    (is_in_line(stands + middle, enough) ? inside : outside) = middle;
  }
  return outside;
}

}  // namespace meridian
