// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/wrist_corridor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/pole_bounds.hpp"
#include "service/core/planner/pole_time.hpp"

namespace meridian {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kLeastPart_mm = 1e-6;
/// Spans farther off than this are not held back.
constexpr double kOutOfReach_rad = 0.6;

}  // namespace

WristCorridor::WristCorridor(const MachineModel& model)
    : model_(model),
      programmed_(has_wrist_roll(model)),
      spans_(has_wrist_roll(model) ? kSpans : 1) {}

void WristCorridor::begin(const Start& start) noexcept {
  is_used_ = has_wrist_roll(model_);
  is_exact_ = model_.pole_policy == PolePolicy::kExact;
  tolerance_rad_ = is_exact_ ? kPoleEase_rad : std::max(start.tolerance_rad, kPoleEase_rad);
  tool_length_mm_ = start.tool_length_mm;
  programmed_.begin(start.axis);
  spans_.clear();
  probe_ = 0;
  emitted_x_ = 0;
  known_ = start.joints;
  branch_ = start.branch;
  is_finished_ = has_zone_ = is_held_ = is_waiting_ = false;
}

void WristCorridor::push(const JointSpan& span) noexcept {
  if (!is_used_) {
    out_ = span;
    is_waiting_ = true;
    return;
  }
  Held held{span, {}};
  for (std::size_t k = 0; k < held.distance.size(); ++k) {
    const double x = span.band.length * static_cast<double>(k) / kProbes;
    held.distance[k] =
        robot::wrist_distance(model_.robot, tool_length_mm_,
                              pose_in_machine(model_, pose_on(span.band.c, x)), branch_, known_);
  }
  spans_.push(held);
}

const BandSpan& WristCorridor::span_at(double u) const noexcept {
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

double WristCorridor::u_of(std::int64_t probe) const noexcept {
  const BandSpan& span = spans_[probe / kProbes].span.band;
  return span.u0 + span.length * static_cast<double>(probe % kProbes) / kProbes;
}

double WristCorridor::distance_of(std::int64_t probe) const noexcept {
  return spans_[probe / kProbes].distance[static_cast<std::size_t>(probe % kProbes)];
}

double WristCorridor::end_u() const noexcept {
  const BandSpan& last = spans_.back().span.band;
  return last.u0 + last.length;
}

double WristCorridor::emitted_u() const noexcept {
  return spans_[spans_.begin_index()].span.band.u0 + emitted_x_;
}

double WristCorridor::distance_at(double u) const noexcept {
  const BandSpan& span = span_at(u);
  return robot::wrist_distance(
      model_.robot, tool_length_mm_,
      pose_in_machine(model_, pose_on(span.c, std::clamp(u - span.u0, 0.0, span.length))), branch_,
      known_);
}

bool WristCorridor::is_minimum(std::int64_t probe) const noexcept {
  const double here = distance_of(probe);
  const bool has_left = probe > kProbes * spans_.begin_index();
  const double left = has_left ? distance_of(probe - 1) : kInfinite;
  const double right = probe + 1 < end_probe() ? distance_of(probe + 1) : kInfinite;
  return here <= left && here <= right;
}

/// About a probe, by golden section between its neighbours.
double WristCorridor::refine_minimum(std::int64_t probe) const noexcept {
  constexpr double kGolden = 0.3819660112501051;
  constexpr int kRounds = 50;
  double low = probe > kProbes * spans_.begin_index() ? u_of(probe - 1) : u_of(probe);
  double high = probe + 1 < end_probe() ? u_of(probe + 1) : end_u();
  for (int n = 0; n < kRounds; ++n) {
    const double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
    if (distance_at(a) <= distance_at(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return 0.5 * (low + high);
}

void WristCorridor::scan() noexcept {
  while (!has_zone_) {
    if (is_held_) {
      if (!settle(emitted_u())) return;
      continue;
    }
    const std::int64_t known = is_finished_ ? end_probe() : end_probe() - 1;
    if (probe_ >= known) return;
    if (!is_minimum(probe_)) {
      ++probe_;
      continue;
    }
    const double nearest = refine_minimum(probe_);
    if (!(distance_at(nearest) < tolerance_rad_)) {
      ++probe_;
    } else if (!settle(nearest)) {
      return;
    }
  }
}

bool WristCorridor::settle(double nearest) noexcept {
  const double wanted = nearest + kWristReach_mm, end = end_u();
  if (end < wanted && !is_finished_ && !spans_.is_full()) return false;
  WristPlace place;
  place.nearest = nearest;
  place.from = is_held_ ? nearest : std::max(emitted_u(), nearest - kWristReach_mm);
  place.to = std::min(wanted, end);
  const double in_line = kOnPoleTolerances * tolerance_rad_;
  const bool is_path_begin = place.from <= 0;
  place.is_start = is_held_ || (is_path_begin && distance_at(place.from) < in_line);
  place.is_end = distance_at(place.to) < in_line;
  place.branch = branch_;
  place.joints = follow_to(place.from);
  const PoleTask task{model_, *this, programmed_, tool_length_mm_, tolerance_rad_, is_exact_};
  zone_ = find_wrist_zone(task, place);
  has_zone_ = zone_.end > zone_.begin;
  is_held_ = has_zone_ && place.is_end;
  const double behind = has_zone_ ? zone_.end : nearest;
  while (probe_ < end_probe() && u_of(probe_) <= behind) ++probe_;
  return true;
}

JointVector WristCorridor::follow_to(double u) const noexcept {
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

bool WristCorridor::may_emit() const noexcept {
  if (has_zone_ || spans_.is_full()) return true;
  if (is_held_) return false;
  if (is_finished_ && probe_ >= end_probe()) return true;
  const Held& front = spans_[spans_.begin_index()];
  const double end = front.span.band.u0 + front.span.band.length;
  if (probe_ < kProbes * (spans_.begin_index() + 1)) return false;
  const double decided = probe_ < end_probe() ? u_of(probe_) : end_u();
  const double least = *std::min_element(front.distance.begin(), front.distance.end());
  return end <= decided - kWristReach_mm || least > kOutOfReach_rad;
}

void WristCorridor::emit() noexcept {
  const JointSpan& front = spans_[spans_.begin_index()].span;
  const BandSpan& span = front.band;
  const double begin = span.u0 + emitted_x_, last = span.u0 + span.length;
  double end = last;
  const auto cut_at = [&](double u) {
    if (has_zone_ && u > begin + kLeastPart_mm && u < end - kLeastPart_mm) end = u;
  };
  cut_at(zone_.begin);
  cut_at(zone_.end);
  const bool is_rest = end == last;
  const double length = is_rest ? span.length - emitted_x_ : end - begin;
  out_ = front;
  if (!is_rest || emitted_x_ > 0) out_.band = part_of_span(span, emitted_x_, length);
  out_.branch = branch_;
  const double middle = begin + 0.5 * length;
  JointVector joints = known_;
  if (has_zone_ && middle > zone_.begin && middle < zone_.end) {
    const double h = zone_.end - zone_.begin;
    out_.is_free_driven = true;
    out_.free = part_of(zone_.roll, begin <= zone_.begin ? 0 : (begin - zone_.begin) / h,
                        end >= zone_.end ? 1 : (end - zone_.begin) / h);
    out_.axis_deviation_rad = zone_.deviation_rad;
    out_.reason =
        zone_.branch_after != zone_.branch_before ? EaseReason::kThrough : EaseReason::kBeside;
    joints = solve_driven(model_, tool_length_mm_, pose_of<double>(span, end), out_.free.back(),
                          branch_, known_)
                 .q;
  } else {
    joints = follow_to(end);
  }
  if (has_zone_ && end >= zone_.end - kLeastPart_mm) {
    branch_ = zone_.branch_after;
    has_zone_ = false;
  }
  known_ = joints;
  emitted_x_ += length;
  if (is_rest) {
    emitted_x_ = 0;
    spans_.drop_before(spans_.begin_index() + 1);
  }
}

const JointSpan* WristCorridor::next() noexcept {
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
