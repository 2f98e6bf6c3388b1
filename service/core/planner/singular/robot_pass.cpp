// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/joint_cells.hpp"
#include "service/core/planner/singular/pole_time.hpp"

namespace meridian {
namespace {

constexpr int kWidths = 18;
constexpr double kNarrower = 0.6;
constexpr int kSamples = 96, kFirstSamples = 12;
constexpr std::size_t kKinks = 192;
constexpr int kRestTurns = 12;  // to each side, of a joint that is to rest elsewhere
constexpr double kRestTurn_rad = std::numbers::pi / kRestTurns;
constexpr double kSameRest_rad = 1e-3;
constexpr double kMaxTipError_mm = 1e-7;
constexpr double kMaxBend_rad = 1e3;  // roll'' h² at an end, beyond it the end is no guide
constexpr double kSamePoint_mm = 1e-4;
constexpr double kNever = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const PassTask& task, const PassRange& range) noexcept
      : task_(task),
        range_(range),
        drives_yaw_(drives(range.at, Singularity::kShoulder)),
        drives_roll_(drives(range.at, Singularity::kWrist)) {
    kink_count_ = task.axes.find_kinks(range.from, range.to, kinks_);
  }

  RobotPass run() noexcept {
    const RobotPass found = search();
    if (found.end > found.begin) return found;
    const RobotPass turned = search_turned();
    if (turned.end > turned.begin) return turned;
    looks_behind_ = false;  // joints leave travel there whatever is chosen
    const RobotPass lost = search();
    return lost.end > lost.begin ? lost : search_turned_off();
  }

 private:
  [[nodiscard]] RobotPass search() noexcept {
    const double widest = std::max(range_.nearest - range_.from, range_.to - range_.last_nearest);
    const int over_arm = comes_out(Singularity::kShoulder) ? robot::kBack : 0;
    const int over_bend = comes_out(Singularity::kWrist) ? robot::kFlip : 0;
    double best = kNever, outside = 0, width = widest;
    RobotPass found;
    for (int n = 0; n < kWidths; ++n, width *= kNarrower) {
      if (n > 0) outside += time_beside(width / kNarrower, width);
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

  /// Where a joint that rests leads others out of their travel: passes after which it rests at
  /// another value, some of them so short that it turns next to standstill.
  [[nodiscard]] RobotPass search_turned() noexcept {
    constexpr double kShares[] = {1, 0.3, 0.1, 0.03, 0.01};
    RobotPass best;
    double best_time = kNever;
    for (const Singularity at : kSingularPlaces) {
      if (!drives(range_.at, at) || comes_out(at)) continue;
      for (const double share : kShares) {
        for (int n = 0; n < 2 * kRestTurns; ++n) {
          turned_ = {at, (n % 2 == 0 ? 1 : -1) * kRestTurn_rad * (1 + n / 2)};
          RobotPass pass = pass_over(range_.nearest - range_.from);
          pass.end = range_.last_nearest + share * (range_.to - range_.last_nearest);
          pass.branch_after = pass.branch_before;
          if (!fit(pass) || !is_inside(pass, kFirstSamples)) continue;
          const double time = time_on(pass);
          if (!(time < best_time) || !is_inside(pass, kSamples) || !is_inside_at_kinks(pass))
            continue;
          if (!rests_on(pass)) continue;
          best_time = time;
          best = pass;
        }
        if (best.end > best.begin) break;
      }
    }
    turned_ = {};
    return best;
  }
  /// Where a joint rests as nothing leads out of the singular place: a short pass that turns it to
  /// where it is behind.
  [[nodiscard]] RobotPass search_turned_off() noexcept {
    constexpr double kShares[] = {0.1, 0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4};
    for (const Singularity at : kSingularPlaces) {
      if (!drives(range_.at, at) || ends_of(at).from != PassEnd::kAtRest || !comes_out(at))
        continue;
      for (const int over : {at == Singularity::kShoulder ? robot::kBack : robot::kFlip, 0}) {
        const auto there = solve(task_.model, task_.tool_length_mm,
                                 pose_of<double>(task_.spans.span_at(range_.to), range_.to),
                                 range_.branch ^ over, range_.joints);
        if (there.status != SolveStatus::kOk) continue;
        const std::size_t joint = joint_of(at);
        turned_ = {at, inside_travel(joint, there.q[joint]) - range_.joints[joint]};
        if (std::abs(turned_.by) < kSameRest_rad) continue;
        for (const double share : kShares) {
          range_.ends[index_of(at)].to = PassEnd::kAtRest;
          RobotPass pass = pass_over(0);
          pass.end = range_.from + share * (range_.to - range_.from);
          pass.branch_after = pass.branch_before;
          const bool is_found = fit(pass) && is_inside(pass, kSamples) && is_inside_at_kinks(pass);
          range_.ends[index_of(at)].to = PassEnd::kOnPath;
          if (is_found) return pass;
        }
      }
    }
    return {};
  }
  /// Whether the driven joints may rest behind the pass as far as the range goes.
  [[nodiscard]] bool rests_on(const RobotPass& pass) const noexcept {
    if (!(pass.end < range_.to)) return true;
    RobotPass rest = pass;
    rest.begin = pass.end;
    rest.end = range_.to;
    rest.joint.fill(pass.joint.back());
    rest.roll.fill(pass.roll.back());
    return is_inside(rest, kSamples);
  }

  [[nodiscard]] const PassEnds& ends_of(Singularity at) const noexcept {
    return range_.ends[index_of(at)];
  }
  /// Whether the joint is driven, and then follows the path.
  [[nodiscard]] bool comes_out(Singularity at) const noexcept {
    return drives(range_.at, at) && ends_of(at).to == PassEnd::kOnPath;
  }
  /// Whether a driven joint rests at that end.
  [[nodiscard]] bool rests_at(PassEnd PassEnds::*end) const noexcept {
    const auto rests = [&](Singularity at) { return ends_of(at).*end == PassEnd::kAtRest; };
    return (drives_yaw_ && rests(Singularity::kShoulder)) ||
           (drives_roll_ && rests(Singularity::kWrist));
  }
  [[nodiscard]] double begin_at(double width) const noexcept {
    return rests_at(&PassEnds::from) ? range_.from
                                     : snapped(std::max(range_.from, range_.nearest - width));
  }
  [[nodiscard]] double end_at(double width) const noexcept {
    return rests_at(&PassEnds::to) ? range_.to
                                   : snapped(std::min(range_.to, range_.last_nearest + width));
  }
  [[nodiscard]] RobotPass pass_over(double width) const noexcept {
    RobotPass pass;
    pass.begin = begin_at(width);
    pass.end = end_at(width);
    pass.branch_before = range_.branch;
    for (const Singularity at : kSingularPlaces) {
      pass.rests[index_of(at)] = drives(range_.at, at) && !comes_out(at);
    }
    return pass;
  }
  /// `u`, or the end of a span that is so close that the part between would be none.
  [[nodiscard]] double snapped(double u) const noexcept {
    const BandSpan& span = task_.spans.span_at(u);
    if (std::abs(u - span.u0) < kSamePoint_mm) return span.u0;
    const double end = span.u0 + span.length;
    return std::abs(end - u) < kSamePoint_mm ? end : u;
  }

  /// Of the exact way, where a pass of the width `to` is narrower than one of `from`.
  [[nodiscard]] double time_beside(double from, double to) const noexcept {
    return time_exactly(begin_at(from), begin_at(to)) + time_exactly(end_at(to), end_at(from));
  }
  [[nodiscard]] double time_exactly(double from, double to) const noexcept {
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

  /// Quintics of all driven joints through both ends.
  bool fit(RobotPass& pass) noexcept {
    reference_ = range_.joints;
    if (!(pass.end - pass.begin > 2 * kSamePoint_mm)) return false;
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
      if (at == turned_.at) out[index_of(at)].value += turned_.by;
    }
    if (!find_slopes(pass, &PassEnds::to, out)) return false;
    for (const Singularity at : kSingularPlaces) {
      if (!drives(range_.at, at)) continue;
      const Slope &from = in[index_of(at)], &to = out[index_of(at)];
      if (!(std::abs(from.bend) < kMaxBend_rad) || !(std::abs(to.bend) < kMaxBend_rad)) {
        return false;
      }
      const FreeQuintic values = quintic_of(from, to);
      if (at == Singularity::kWrist) pass.roll = values;
      if (at == Singularity::kShoulder || range_.at == at) pass.joint = values;
    }
    return true;
  }

  /// A driven joint at an end, with two derivatives by the share of the pass.
  struct Slope {
    double value = 0, rate = 0, bend = 0;
  };
  using Slopes = std::array<Slope, kSingularities>;
  [[nodiscard]] static FreeQuintic quintic_of(const Slope& a, const Slope& b) noexcept {
    return {a.value,
            a.value + a.rate / 5,
            a.value + 0.4 * a.rate + a.bend / 20,
            b.value - 0.4 * b.rate + b.bend / 20,
            b.value - b.rate / 5,
            b.value};
  }
  /// Sets those of joints that do not rest at the end to the exact way; those that rest have their
  /// value.
  bool find_slopes(const RobotPass& pass, PassEnd PassEnds::*end, Slopes& slopes) const noexcept {
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
      if (!is_begin) {
        slopes[index_of(at)].value = inside_travel(joint_of(at), value_of(q));
      }
    }
    return true;
  }
  [[nodiscard]] static std::size_t joint_of(Singularity at) noexcept {
    return at == Singularity::kShoulder ? std::size_t{robot::kYaw} : std::size_t{robot::kRoll};
  }
  /// `value`, or the winding of it inside travel.
  [[nodiscard]] double inside_travel(std::size_t joint, double value) const noexcept {
    const JointSpec& spec = task_.model.joints[joint];
    return is_inside_travel(spec, value, kTravelMargin)
               ? value
               : unwind_inside(value, value, spec.limits.travel_min, spec.limits.travel_max,
                               kTravelMargin);
  }

  /// A stretch of the exact way.
  struct Stretch {
    double from = 0, to = 0;
    int branch = 0;
    bool keeps_travel = false;
  };
  /// Follows the joints to its end; false: there are none there, or they leave travel.
  [[nodiscard]] bool follow(const Stretch& way, JointVector& joints) const noexcept {
    constexpr int kSteps = 48;
    for (int k = 1; k <= kSteps; ++k) {
      const double at = way.from + (way.to - way.from) * k / kSteps;
      const auto there = solve(task_.model, task_.tool_length_mm,
                               pose_of<double>(task_.spans.span_at(at), at), way.branch, joints);
      if (there.status == SolveStatus::kUnreachable) return false;
      joints = there.q;
      const bool is_out = first_joint_outside_travel(task_.model, joints, kTravelMargin) >= 0;
      if (way.keeps_travel && is_out) return false;
    }
    return true;
  }

  /// Whether the exact way behind the pass keeps travel, as far as the place goes.
  [[nodiscard]] bool leads_on(const RobotPass& pass) const noexcept {
    if (rests_at(&PassEnds::to)) return true;
    JointVector joints = reference_;
    if (drives_roll_) joints[robot::kRoll] = pass.roll.back();
    if (drives_yaw_) joints[robot::kYaw] = pass.joint.back();
    return follow({pass.end, range_.to, pass.branch_after, true}, joints);
  }

  template <class S>
  [[nodiscard]] Solution<S> solve_on(const RobotPass& pass, const Pose<S>& pose, const S& joint,
                                     const S& roll) const noexcept {
    return solve_driven(task_.model, task_.tool_length_mm, pose, joint, roll,
                        driven_branch(range_.at, pass.branch_before), reference_);
  }

  /// How far the tool is off the programmed path, as the pass may be.
  struct Off {
    double tip_mm = kNever, axis_rad = kNever;
  };
  /// Infinite where a joint leaves travel.
  [[nodiscard]] Off off_at(const RobotPass& pass, double u) const noexcept {
    const ToolPose pose = pose_of<double>(task_.spans.span_at(u), u);
    const double share = (u - pass.begin) / (pass.end - pass.begin);
    const auto at =
        solve_on(pass, pose, quintic_at(pass.joint, share), quintic_at(pass.roll, share));
    if (at.status == SolveStatus::kUnreachable) return {};
    if (first_joint_outside_travel(task_.model, at.q, kTravelMargin) >= 0) return {};
    const ToolPose there = forward(task_.model, task_.tool_length_mm, at.q);
    const double tip = (there.tip - pose.tip).norm();
    Off out{0, 0};
    if (drives_yaw_) {
      out.tip_mm = task_.is_exact ? tip : task_.tips.distance_to(u, there.tip);
    } else if (!(tip <= kMaxTipError_mm)) {
      return {};
    }
    if (drives_roll_) {
      out.axis_rad = task_.is_exact ? angle_between(pose.axis, there.axis)
                                    : task_.axes.angle_to(u, there.axis);
    }
    return out;
  }

  bool is_within(RobotPass& pass, double u) const noexcept {
    const Off off = off_at(pass, u);
    pass.axis_deviation_rad = std::max(pass.axis_deviation_rad, off.axis_rad);
    return off.tip_mm <= kSampledShare * task_.tip_tolerance_mm &&
           off.axis_rad <= kSampledShare * task_.axis_tolerance_rad;
  }
  bool is_inside(RobotPass& pass, int samples) const noexcept {
    for (int k = 0; k <= samples; ++k) {
      if (!is_within(pass, pass.begin + (pass.end - pass.begin) * k / samples)) return false;
    }
    return true;
  }
  /// The same where the programmed axis turns sharply.
  bool is_inside_at_kinks(RobotPass& pass) const noexcept {
    for (std::size_t n = 0; n < kink_count_; ++n) {
      const bool is_there = kinks_[n] > pass.begin && kinks_[n] < pass.end;
      if (is_there && !is_within(pass, kinks_[n])) return false;
    }
    return true;
  }

  [[nodiscard]] double time_on(const RobotPass& pass) const noexcept {
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

  const PassTask& task_;
  PassRange range_;
  bool drives_yaw_, drives_roll_;
  std::array<double, kKinks> kinks_{};  // u
  std::size_t kink_count_ = 0;
  bool looks_behind_ = true;
  struct Turned {
    Singularity at = Singularity::kWrist;
    double by = 0;
  } turned_;                 // a joint that is to rest elsewhere
  JointVector reference_{};  // at the begin of the pass that was fitted last
};

}  // namespace

RobotPass find_robot_pass(const PassTask& task, const PassRange& range) noexcept {
  return Search(task, range).run();
}

}  // namespace meridian
