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
constexpr double kMaxTipError_mm = 1e-7;
constexpr double kMaxBend_rad = 1e3;  // roll'' h² at an end, beyond it the end is no guide
constexpr double kSamePoint_mm = 1e-4;
constexpr double kNever = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const PassTask& task, const PassRange& range) noexcept
      : task_(task),
        range_(range),
        joint_(driven_joint(task.model, driven_branch(range.at, 0))),
        turned_over_(range.at == Singularity::kWrist ? robot::kFlip : robot::kBack) {
    kink_count_ = task.axes.find_kinks(range.from, range.to, kinks_);
  }

  RobotPass run() noexcept {
    const RobotPass found = search();
    if (found.end > found.begin) return found;
    const RobotPass turned = search_turned();
    if (turned.end > turned.begin) return turned;
    looks_behind_ = false;  // joints leave travel there whatever is chosen
    return search();
  }

 private:
  [[nodiscard]] RobotPass search() noexcept {
    const double widest = std::max(range_.nearest - range_.from, range_.to - range_.nearest);
    double best = kNever, outside = 0, width = widest;
    RobotPass found;
    for (int n = 0; n < kWidths; ++n, width *= kNarrower) {
      if (n > 0) outside += time_beside(width / kNarrower, width);
      if (!(outside < best)) break;
      for (const int flip : {turned_over_, 0}) {
        RobotPass pass = pass_over(width);
        pass.branch_after = pass.branch_before ^ flip;
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

  /// Where the joint at rest leads others out of their travel: passes after which it rests at
  /// another value, some of them so short that it turns next to standstill.
  [[nodiscard]] RobotPass search_turned() noexcept {
    constexpr double kShares[] = {1, 0.3, 0.1, 0.03, 0.01};
    RobotPass best;
    if (range_.at_to != PassEnd::kAtRest) return best;
    double best_time = kNever;
    for (const double share : kShares) {
      for (int n = 0; n < 2 * kRestTurns; ++n) {
        rest_turn_ = (n % 2 == 0 ? 1 : -1) * kRestTurn_rad * (1 + n / 2);
        RobotPass pass = pass_over(range_.nearest - range_.from);
        pass.end = range_.nearest + share * (range_.to - range_.nearest);
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
    rest_turn_ = 0;
    return best;
  }
  /// Whether the joint may rest behind the pass as far as the range goes.
  [[nodiscard]] bool rests_on(const RobotPass& pass) const noexcept {
    if (!(pass.end < range_.to)) return true;
    RobotPass rest = pass;
    rest.begin = pass.end;
    rest.end = range_.to;
    rest.joint.fill(pass.joint.back());
    return is_inside(rest, kSamples);
  }

  [[nodiscard]] double begin_at(double width) const noexcept {
    return range_.at_from == PassEnd::kAtRest
               ? range_.from
               : snapped(std::max(range_.from, range_.nearest - width));
  }
  [[nodiscard]] double end_at(double width) const noexcept {
    return range_.at_to == PassEnd::kAtRest ? range_.to
                                            : snapped(std::min(range_.to, range_.nearest + width));
  }
  [[nodiscard]] RobotPass pass_over(double width) const noexcept {
    RobotPass pass;
    pass.begin = begin_at(width);
    pass.end = end_at(width);
    pass.branch_before = range_.branch;
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

  /// The quintic through both ends.
  bool fit(RobotPass& pass) noexcept {
    const double h = pass.end - pass.begin;
    if (!(h > 2 * kSamePoint_mm)) return false;
    JointVector reference = range_.joints;
    double from = reference[joint_], a1 = 0, a2 = 0;  // a start: at rest where it is
    if (range_.at_from == PassEnd::kOnPath) {
      if (!follow({range_.from, pass.begin, range_.branch, false}, reference)) return false;
      const auto in = solve(task_.model, task_.tool_length_mm,
                            pose_of<Jet<2>>(task_.spans.span_at(pass.begin), pass.begin),
                            pass.branch_before, reference);
      if (in.status != SolveStatus::kOk) return false;
      from = value_of(in.q[joint_]);
      a1 = in.q[joint_].derivative(1) * h;
      a2 = in.q[joint_].derivative(2) * h * h;
      for (std::size_t i = 0; i < reference.size(); ++i) reference[i] = value_of(in.q[i]);
    }
    double to = from + 0.5 * a1 + rest_turn_, b1 = 0, b2 = 0;  // an end: comes to rest
    if (range_.at_to == PassEnd::kAtRest) {
      pass.branch_after = pass.branch_before;
    } else {
      const auto out = solve(task_.model, task_.tool_length_mm,
                             pose_of<Jet<2>>(task_.spans.span_at(pass.end), pass.end),
                             pass.branch_after, reference);
      if (out.status != SolveStatus::kOk) return false;
      to = inside_travel(value_of(out.q[joint_]));
      b1 = out.q[joint_].derivative(1) * h;
      b2 = out.q[joint_].derivative(2) * h * h;
    }
    if (!(std::abs(a2) < kMaxBend_rad) || !(std::abs(b2) < kMaxBend_rad)) return false;
    pass.joint = {
        from, from + a1 / 5, from + 0.4 * a1 + a2 / 20, to - 0.4 * b1 + b2 / 20, to - b1 / 5, to};
    reference_ = reference;
    return true;
  }

  /// `value`, or the winding of it inside travel.
  [[nodiscard]] double inside_travel(double value) const noexcept {
    const JointSpec& spec = task_.model.joints[static_cast<std::size_t>(joint_)];
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
    if (range_.at_to == PassEnd::kAtRest) return true;
    JointVector joints = reference_;
    joints[joint_] = pass.joint.back();
    return follow({pass.end, range_.to, pass.branch_after, true}, joints);
  }

  /// How far the tool is off the programmed path at `u`, as the pass may be; infinite where a joint
  /// leaves travel.
  [[nodiscard]] double off_at(const RobotPass& pass, double u) const noexcept {
    const ToolPose pose = pose_of<double>(task_.spans.span_at(u), u);
    const double joint = quintic_at(pass.joint, (u - pass.begin) / (pass.end - pass.begin));
    const auto at = solve_driven(task_.model, task_.tool_length_mm, pose, joint,
                                 driven_branch(range_.at, pass.branch_before), reference_);
    if (at.status == SolveStatus::kUnreachable) return kNever;
    if (first_joint_outside_travel(task_.model, at.q, kTravelMargin) >= 0) return kNever;
    const ToolPose there = forward(task_.model, task_.tool_length_mm, at.q);
    const double tip = (there.tip - pose.tip).norm();
    if (range_.at == Singularity::kShoulder) {
      return task_.is_exact ? tip : task_.tips.distance_to(u, there.tip);
    }
    if (!(tip <= kMaxTipError_mm)) return kNever;
    return task_.is_exact ? angle_between(pose.axis, there.axis)
                          : task_.axes.angle_to(u, there.axis);
  }

  [[nodiscard]] double tolerance() const noexcept {
    return range_.at == Singularity::kWrist ? task_.axis_tolerance_rad : task_.tip_tolerance_mm;
  }

  bool is_within(RobotPass& pass, double u) const noexcept {
    const double off = off_at(pass, u);
    pass.deviation = std::max(pass.deviation, off);
    return off <= kSampledShare * tolerance();
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
      const auto at =
          solve_driven(task_.model, task_.tool_length_mm, pose, free_at(pass.joint, t, h),
                       driven_branch(range_.at, pass.branch_before), reference_);
      sum += h / kSteps * slowness(task_.model, span, pose, at.q);
    }
    return sum;
  }

  const PassTask& task_;
  const PassRange& range_;
  int joint_, turned_over_;             // the bit of a branch
  std::array<double, kKinks> kinks_{};  // u
  std::size_t kink_count_ = 0;
  bool looks_behind_ = true;
  double rest_turn_ = 0;     // by which the joint is to rest elsewhere
  JointVector reference_{};  // at the begin of the pass that was fitted last
};

}  // namespace

RobotPass find_robot_pass(const PassTask& task, const PassRange& range) noexcept {
  return Search(task, range).run();
}

}  // namespace meridian
