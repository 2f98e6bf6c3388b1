// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/robot_passes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "service/core/planner/singular/robot/pass_joints.hpp"

namespace meridian {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMinPassPart_mm = 1e-6;
/// Spans farther off than this are not held back.
constexpr double kPassOutOfReach_rad = 0.6, kPassOutOfReach_mm = 100;
/// Of the tip, where nothing may give: kPoleDeviation_rad at the end of a tool.
constexpr double kExactTip_mm = 1e-3;
constexpr Singularity kBothSingularities[] = {Singularity::kShoulder, Singularity::kWrist};

bool is_robot(const MachineModel& model) noexcept { return model.family == MachineFamily::kRobot; }

std::size_t index_of(Singularity at) noexcept { return static_cast<std::size_t>(at); }

}  // namespace

RobotPasses::RobotPasses(const MachineModel& model)
    : model_(model),
      axes_(is_robot(model)),
      tips_(is_robot(model)),
      spans_(is_robot(model) ? kSpans : 1) {}

void RobotPasses::begin(const Start& start) noexcept {
  is_used_ = is_robot(model_);
  is_exact_ = model_.pole_policy == PolePolicy::kExact;
  axis_tolerance_rad_ =
      is_exact_ ? kPoleDeviation_rad : std::max(start.axis_tolerance_rad, kPoleDeviation_rad);
  tip_tolerance_mm_ = is_exact_ ? kExactTip_mm : std::max(start.tip_tolerance_mm, kExactTip_mm);
  tool_length_mm_ = start.tool_length_mm;
  axes_.begin(start.pose.axis);
  tips_.begin(start.pose.tip);
  spans_.clear();
  probe_ = 0;
  emitted_x_ = 0;
  known_ = start.joints;
  branch_ = start.branch;
  is_finished_ = has_pass_ = is_waiting_ = false;
  held_ = SingularSet::kNone;
  pass_ = {};
}

void RobotPasses::push(const JointSpan& span) noexcept {
  if (!is_used_) {
    out_ = span;
    is_waiting_ = true;
    return;
  }
  Held held{span, {}};
  measure(held);
  spans_.push(held);
}

void RobotPasses::measure(Held& held) const noexcept {
  for (std::size_t k = 0; k < kProbes; ++k) {
    const double x = held.span.band.length * static_cast<double>(k) / kProbes;
    const ToolPose pose = pose_on(held.span.band.c, x);
    for (const Singularity at : kBothSingularities) {
      held.distance[index_of(at)][k] =
          singular_distance(model_, tool_length_mm_, at, pose, branch_, known_);
    }
  }
}

const BandSpan& RobotPasses::span_at(double u) const noexcept {
  std::int64_t low = spans_.begin_index(), high = spans_.end_index() - 1;
  while (low < high) {
    const std::int64_t middle = low + (high - low + 1) / 2;
    if (spans_[middle].span.band.u0 <= u) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return spans_[low].span.band;
}

double RobotPasses::u_of(std::int64_t probe) const noexcept {
  const BandSpan& span = spans_[probe / kProbes].span.band;
  return span.u0 + span.length * static_cast<double>(probe % kProbes) / kProbes;
}

double RobotPasses::distance_of(Singularity at, std::int64_t probe) const noexcept {
  const auto& distance = spans_[probe / kProbes].distance[index_of(at)];
  return distance[static_cast<std::size_t>(probe % kProbes)];
}

double RobotPasses::end_u() const noexcept {
  const BandSpan& last = spans_.back().span.band;
  return last.u0 + last.length;
}

double RobotPasses::emitted_u() const noexcept {
  return spans_[spans_.begin_index()].span.band.u0 + emitted_x_;
}

double RobotPasses::distance_at(Singularity at, double u) const noexcept {
  const ToolPose pose = pose_of<double>(span_at(u), u);
  return singular_distance(model_, tool_length_mm_, at, pose, branch_, known_);
}

bool RobotPasses::is_minimum(Singularity at, std::int64_t probe) const noexcept {
  const double here = distance_of(at, probe);
  if (!(here < kInfinite)) return false;
  const bool has_left = probe > kProbes * spans_.begin_index();
  const double left = has_left ? distance_of(at, probe - 1) : kInfinite;
  const double right = probe + 1 < end_probe() ? distance_of(at, probe + 1) : kInfinite;
  return here <= left && here <= right;
}

/// About a probe, by golden section between its neighbours.
double RobotPasses::refine_minimum(Singularity at, std::int64_t probe) const noexcept {
  constexpr double kGolden = 0.3819660112501051;
  constexpr int kRounds = 50;
  double low = probe > kProbes * spans_.begin_index() ? u_of(probe - 1) : u_of(probe);
  double high = probe + 1 < end_probe() ? u_of(probe + 1) : end_u();
  for (int n = 0; n < kRounds; ++n) {
    const double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
    if (distance_at(at, a) <= distance_at(at, b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return 0.5 * (low + high);
}

void RobotPasses::scan() noexcept {
  while (!has_pass_) {
    if (goes_on()) {
      const bool is_wrist = held_ == SingularSet::kWrist;
      if (!settle(is_wrist ? Singularity::kWrist : Singularity::kShoulder, emitted_u())) return;
      continue;
    }
    const std::int64_t known = is_finished_ ? end_probe() : end_probe() - 1;
    if (probe_ >= known) return;
    for (const Singularity at : kBothSingularities) {
      if (!is_minimum(at, probe_)) continue;
      const double nearest = refine_minimum(at, probe_);
      if (!(distance_at(at, nearest) < tolerance(at))) continue;
      if (!settle(at, nearest)) return;
      if (has_pass_) break;
    }
    if (!has_pass_) ++probe_;
  }
}

PassTask RobotPasses::task() const noexcept {
  return {model_,   *this, axes_, tips_, tool_length_mm_, axis_tolerance_rad_, tip_tolerance_mm_,
          is_exact_};
}

bool RobotPasses::settle(Singularity at, double nearest) noexcept {
  const double wanted = nearest + kPassReach_mm, end = end_u();
  if (end < wanted && !is_finished_ && !spans_.is_full()) return false;
  PassRange range;
  range.at = at;
  range.nearest = nearest;
  const bool is_held = goes_on();
  range.from = is_held ? nearest : std::max(emitted_u(), nearest - kPassReach_mm);
  range.to = std::min(wanted, end);
  const bool is_start = !is_held && !(range.from > 0);
  range.rests_at_from = is_start ? singular_at(range.from, kOnPoleTolerances) : held_;
  range.rests_at_to = singular_at(range.to, kOnPoleTolerances);
  if (is_start && !is_exact_) range.stops_at_from = singular_at(range.from, kSampledShare);
  const bool is_end = is_finished_ && !(range.to < end);
  if (is_end && !is_exact_) range.stops_at_to = singular_at(range.to, kStopTolerances);
  range.branch = branch_;
  range.joints = follow_to(range.from);
  pass_ = find_robot_pass(task(), range);
  has_pass_ = pass_.end > pass_.begin;
  held_ = pass_.rests_at_end;
  while (has_pass_ && probe_ < end_probe() && u_of(probe_) <= pass_.end) ++probe_;
  return true;
}

bool RobotPasses::goes_on() const noexcept {
  if (held_ != SingularSet::kNone) return true;
  const double u = emitted_u();
  return pass_.at == SingularSet::kWristAndShoulder && std::abs(u - pass_.end) < kMinPassPart_mm &&
         distance_at(Singularity::kWrist, u) < axis_tolerance_rad_ &&
         distance_at(Singularity::kShoulder, u) < tip_tolerance_mm_;
}

SingularSet RobotPasses::singular_at(double u, double share) const noexcept {
  SingularSet set = SingularSet::kNone;
  for (const Singularity at : kBothSingularities) {
    if (distance_at(at, u) < share * tolerance(at)) set = set | only(at);
  }
  return set;
}

JointVector RobotPasses::follow_to(double u) const noexcept {
  constexpr int kSteps = 48;
  JointVector joints = known_;
  const double from = emitted_u();
  for (int k = 1; k <= kSteps && u > from; ++k) {
    const double at = from + (u - from) * k / kSteps;
    const BandSpan& span = span_at(at);
    const auto there = solve(model_, tool_length_mm_, pose_of<double>(span, at), branch_, joints);
    if (there.status != SolveStatus::kUnreachable) joints = there.q;
  }
  return joints;
}

bool RobotPasses::may_emit() const noexcept {
  if (has_pass_ || spans_.is_full()) return true;
  if (goes_on()) return false;
  if (is_finished_ && probe_ >= end_probe()) return true;
  const Held& front = spans_[spans_.begin_index()];
  const double end = front.span.band.u0 + front.span.band.length;
  if (probe_ < kProbes * (spans_.begin_index() + 1)) return false;
  const double decided = probe_ < end_probe() ? u_of(probe_) : end_u();
  return end <= decided - kPassReach_mm || is_out_of_reach(front);
}

bool RobotPasses::is_out_of_reach(const Held& held) const noexcept {
  const auto smallest = [&](Singularity at) {
    const auto& distance = held.distance[index_of(at)];
    return *std::min_element(distance.begin(), distance.end());
  };
  return smallest(Singularity::kWrist) > kPassOutOfReach_rad &&
         smallest(Singularity::kShoulder) > kPassOutOfReach_mm;
}

void RobotPasses::emit() noexcept {
  const JointSpan& front = spans_[spans_.begin_index()].span;
  const BandSpan& span = front.band;
  const double begin = span.u0 + emitted_x_, last = span.u0 + span.length;
  double end = last;
  const auto cut_at = [&](double u) {
    if (has_pass_ && u > begin + kMinPassPart_mm && u < end - kMinPassPart_mm) end = u;
  };
  cut_at(pass_.begin);
  cut_at(pass_.end);
  const bool is_rest = end == last;
  const double length = is_rest ? span.length - emitted_x_ : end - begin;
  out_ = front;
  if (!is_rest || emitted_x_ > 0) out_.band = part_of_span(span, emitted_x_, length);
  out_.branch = branch_;
  const double middle = begin + 0.5 * length;
  JointVector joints = known_;
  if (has_pass_ && middle > pass_.begin && middle < pass_.end) {
    const double h = pass_.end - pass_.begin;
    out_.is_free_driven = true;
    const double from = begin <= pass_.begin ? 0 : (begin - pass_.begin) / h;
    const double to = end >= pass_.end ? 1 : (end - pass_.begin) / h;
    out_.branch = driven_branch(pass_.at, branch_);
    out_.free = part_of(pass_.joint, from, to);
    out_.roll = part_of(pass_.roll, from, to);
    out_.axis_deviation_rad = pass_.axis_deviation_rad;
    out_.reason = reason_of(pass_);
    joints = solve_on_pass<double>(task(), pass_, pose_of<double>(span, end), out_.free.back(),
                                   out_.roll.back(), known_)
                 .q;
  } else {
    joints = follow_to(end);
  }
  known_ = joints;
  if (has_pass_ && end >= pass_.end - kMinPassPart_mm) {
    branch_ = pass_.branch_after;
    has_pass_ = false;
    if (pass_.branch_after != pass_.branch_before) {  // the arm may stand otherwise
      for (std::int64_t n = spans_.begin_index(); n < spans_.end_index(); ++n) measure(spans_[n]);
    }
  }
  emitted_x_ += length;
  if (is_rest) {
    emitted_x_ = 0;
    spans_.drop_before(spans_.begin_index() + 1);
  }
}

const JointSpan* RobotPasses::next() noexcept {
  if (!is_used_) {
    return std::exchange(is_waiting_, false) ? &out_ : nullptr;
  }
  if (spans_.begin_index() == spans_.end_index()) return nullptr;
  scan();
  if (!may_emit()) return nullptr;
  emit();
  return &out_;
}

}  // namespace meridian
