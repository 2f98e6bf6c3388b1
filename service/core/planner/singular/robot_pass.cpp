// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot_pass.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/joint_cells.hpp"
#include "service/core/planner/singular/robot_pass_search.hpp"

/// The candidates for a pass, and which is taken. Part of RobotPassSearch.
namespace meridian {
namespace {

constexpr int kPassWidths = 18;
constexpr double kNarrowerPass = 0.6;
constexpr double kShortestPass_mm = 2e-4;
constexpr double kMaxPassBend_rad = 1e3;  // roll'' h² at an end, beyond it the end is no guide
constexpr double kSamePassEnd_mm = 1e-4;
constexpr double kNarrowFromRest_mm = 1;  // narrower: the joint first turns at rest instead

}  // namespace

RobotPassSearch::RobotPassSearch(const PassTask& task, const PassRange& range) noexcept
    : task_(task),
      range_(range),
      drives_yaw_(drives(range.at, Singularity::kShoulder)),
      drives_roll_(drives(range.at, Singularity::kWrist)) {
  kink_count_ = task.axes.find_kinks(range.from, range.to, kinks_);
}

RobotPass RobotPassSearch::run() noexcept {
  const RobotPass found = search();
  if (is_pass(found)) {
    if (!rests_at(&PassEnds::from) || !is_narrow(found)) return found;
    const RobotPass turned = search_turned_off();
    if (is_pass(turned)) return turned;
    return range_.at == Singularity::kBoth && !range_.may_be_narrow ? RobotPass{} : found;
  }
  const RobotPass turned = search_turned();
  if (is_pass(turned)) return turned;
  looks_behind_ = false;  // joints leave travel there whatever is chosen
  const RobotPass lost = search();
  return is_pass(lost) ? lost : search_turned_off();
}

bool RobotPassSearch::is_narrow(const RobotPass& pass) const noexcept {
  return pass.end - pass.begin < std::min(kNarrowFromRest_mm, 0.5 * (range_.to - range_.from));
}

RobotPass RobotPassSearch::search() noexcept {
  const double widest = std::max(range_.nearest - range_.from, range_.to - range_.last_nearest);
  const int over_arm = comes_out(Singularity::kShoulder) ? robot::kBack : 0;
  const int over_bend = comes_out(Singularity::kWrist) ? robot::kFlip : 0;
  double best = kNever, outside = 0, width = widest;
  RobotPass found;
  for (int n = 0; n < kPassWidths; ++n, width *= kNarrowerPass) {
    if (n > 0) outside += time_beside(width / kNarrowerPass, width);
    if (!(outside < best)) break;
    for (int k = 0; k < 4; ++k) {
      const int over = ((k & 1) == 0 ? over_arm : 0) | ((k & 2) == 0 ? over_bend : 0);
      const bool is_twice = (over_arm == 0 && (k & 1) != 0) || (over_bend == 0 && (k & 2) != 0);
      if (is_twice) continue;
      RobotPass pass = pass_over(width);
      pass.branch_after = pass.branch_before ^ over;
      if (!fit(pass) || !is_inside(pass, kFirstSamples)) continue;
      const double time = outside + time_on(pass);
      if (!(time < best) || !is_inside(pass, kSamples) || !is_inside_at_kinks(pass)) continue;
      if (looks_behind_ && !leads_on(pass)) continue;
      best = time;
      found = pass;
    }
  }
  return found;
}

bool RobotPassSearch::rests_at(PassEnd PassEnds::*end) const noexcept {
  const auto rests = [&](Singularity at) { return ends_of(at).*end == PassEnd::kAtRest; };
  return (drives_yaw_ && rests(Singularity::kShoulder)) ||
         (drives_roll_ && rests(Singularity::kWrist));
}

double RobotPassSearch::begin_at(double width) const noexcept {
  return rests_at(&PassEnds::from) ? range_.from
                                   : snapped(std::max(range_.from, range_.nearest - width));
}

double RobotPassSearch::end_at(double width) const noexcept {
  return rests_at(&PassEnds::to) ? range_.to
                                 : snapped(std::min(range_.to, range_.last_nearest + width));
}

RobotPass RobotPassSearch::pass_over(double width) const noexcept {
  RobotPass pass;
  pass.begin = begin_at(width);
  pass.end = end_at(width);
  pass.branch_before = pass.branch_after = range_.branch;
  for (const Singularity at : kSingularPlaces) {
    pass.rests[index_of(at)] = drives(range_.at, at) && !comes_out(at);
  }
  return pass;
}

double RobotPassSearch::snapped(double u) const noexcept {
  const BandSpan& span = task_.spans.span_at(u);
  if (std::abs(u - span.u0) < kSamePassEnd_mm) return span.u0;
  const double end = span.u0 + span.length;
  return std::abs(end - u) < kSamePassEnd_mm ? end : u;
}

double RobotPassSearch::time_beside(double from, double to) const noexcept {
  return time_exactly(begin_at(from), begin_at(to)) + time_exactly(end_at(to), end_at(from));
}

double RobotPassSearch::time_exactly(double from, double to) const noexcept {
  constexpr int kSteps = 4;
  double sum = 0;
  for (int k = 0; k < kSteps && to > from; ++k) {
    const double u = from + (to - from) * (k + 0.5) / kSteps;
    const BandSpan& span = task_.spans.span_at(u);
    const auto pose = pose_of<Jet<3>>(span, u);
    const auto at = solve(task_.model, task_.tool_length_mm, pose, range_.branch, range_.joints);
    if (at.status == SolveStatus::kUnreachable) return kNever;
    sum += (to - from) / kSteps * slowness(task_.model, span, pose, at.q);
  }
  return sum;
}

double RobotPassSearch::time_on(const RobotPass& pass) const noexcept {
  constexpr int kSteps = kSamples / 2;
  const double h = pass.end - pass.begin;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double t = (k + 0.5) / kSteps, u = pass.begin + t * h;
    const BandSpan& span = task_.spans.span_at(u);
    const auto pose = pose_of<Jet<3>>(span, u);
    const auto at = solve_on(pass, pose, free_at(pass.joint, t, h), free_at(pass.roll, t, h));
    sum += h / kSteps * slowness(task_.model, span, pose, at.q);
  }
  return sum;
}

bool RobotPassSearch::fit(RobotPass& pass) noexcept {
  reference_ = range_.joints;
  if (!(pass.end - pass.begin > kShortestPass_mm)) return false;
  const bool follows = pass.begin > range_.from;
  if (follows && !follow({range_.from, pass.begin, range_.branch, false}, reference_)) {
    return false;
  }
  Slopes in, out;
  for (const Singularity at : kSingularPlaces) in[index_of(at)].value = reference_[joint_of(at)];
  if (!find_slopes(pass, &PassEnds::from, in)) return false;
  for (const Singularity at : kSingularPlaces) {
    if (drives(range_.at, at)) reference_[joint_of(at)] = in[index_of(at)].value;
    out[index_of(at)].value = in[index_of(at)].value + 0.5 * in[index_of(at)].rate;
    out[index_of(at)].value += turned_[index_of(at)];
  }
  if (!find_slopes(pass, &PassEnds::to, out)) return false;
  for (const Singularity at : kSingularPlaces) {
    if (!drives(range_.at, at)) continue;
    const Slope &from = in[index_of(at)], &to = out[index_of(at)];
    const bool is_guided =
        std::abs(from.bend) < kMaxPassBend_rad && std::abs(to.bend) < kMaxPassBend_rad;
    if (!is_guided) return false;
    const FreeQuintic values = quintic_of(from, to);
    if (at == Singularity::kWrist) pass.roll = values;
    if (at == Singularity::kShoulder || range_.at == at) pass.joint = values;
  }
  return true;
}

FreeQuintic RobotPassSearch::quintic_of(const Slope& a, const Slope& b) noexcept {
  return {a.value,
          a.value + a.rate / 5,
          a.value + 0.4 * a.rate + a.bend / 20,
          b.value - 0.4 * b.rate + b.bend / 20,
          b.value - b.rate / 5,
          b.value};
}

bool RobotPassSearch::find_slopes(const RobotPass& pass, PassEnd PassEnds::*end,
                                  Slopes& slopes) const noexcept {
  const bool is_begin = end == &PassEnds::from;
  const double u = is_begin ? pass.begin : pass.end, h = pass.end - pass.begin;
  const int branch = is_begin ? pass.branch_before : pass.branch_after;
  const auto pose = pose_of<Jet<2>>(task_.spans.span_at(u), u);
  for (const Singularity at : kSingularPlaces) {
    if (!drives(range_.at, at) || ends_of(at).*end == PassEnd::kAtRest) continue;
    const Singularity other = other_of(at);
    const bool other_rests = drives(range_.at, other) && ends_of(other).*end == PassEnd::kAtRest;
    const auto found = other_rests
                           ? solve_driven(task_.model, task_.tool_length_mm, pose,
                                          Jet<2>(slopes[index_of(other)].value),
                                          driven_branch(other, branch), reference_)
                           : solve(task_.model, task_.tool_length_mm, pose, branch, reference_);
    if (found.status != SolveStatus::kOk) return false;
    const Jet<2>& q = found.q[joint_of(at)];
    slopes[index_of(at)] = {value_of(q), q.derivative(1) * h, q.derivative(2) * h * h};
    if (!is_begin) slopes[index_of(at)].value = inside_travel(joint_of(at), value_of(q));
  }
  return true;
}

double RobotPassSearch::inside_travel(std::size_t joint, double value) const noexcept {
  const JointSpec& spec = task_.model.joints[joint];
  return is_inside_travel(spec, value, kTravelMargin)
             ? value
             : unwind_inside(value, value, spec.limits.travel_min, spec.limits.travel_max,
                             kTravelMargin);
}

RobotPass find_robot_pass(const PassTask& task, const PassRange& range) noexcept {
  return RobotPassSearch(task, range).run();
}

}  // namespace meridian
