// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/wrist_zone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/joint_cells.hpp"
#include "service/core/planner/pole_time.hpp"

namespace meridian {
namespace {

constexpr int kRoll = robot::kRoll;
constexpr int kFlip = 4;  // bit of a branch: the bend turned round
constexpr int kWidths = 18;
constexpr double kNarrower = 0.6;
constexpr int kSamples = 96, kFirstSamples = 12;
constexpr std::size_t kKinks = 192;
constexpr double kToleranceShare = 0.998;  // samples are not everywhere
constexpr double kMostTipError_mm = 1e-7;
constexpr double kMostBend_rad = 1e3;  // roll'' h² at an end, beyond it the end is no guide
constexpr double kLeastPart_mm = 1e-4;
constexpr double kNever = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const PoleTask& task, const WristPlace& place) noexcept : task_(task), place_(place) {
    kink_count_ = task.programmed.find_kinks(place.from, place.to, kinks_);
  }

  WristZone run() noexcept {
    const WristZone found = search();
    if (found.end > found.begin) return found;
    looks_behind_ = false;  // joints leave travel there whatever is chosen
    return search();
  }

 private:
  [[nodiscard]] WristZone search() noexcept {
    const double widest = std::max(place_.nearest - place_.from, place_.to - place_.nearest);
    double best = kNever, outside = 0, width = widest;
    WristZone found;
    for (int n = 0; n < kWidths; ++n, width *= kNarrower) {
      if (n > 0) outside += time_beside(width / kNarrower, width);
      if (!(outside < best)) break;
      for (const int flip : {kFlip, 0}) {
        WristZone zone = zone_of(width);
        zone.branch_after = zone.branch_before ^ flip;
        if (!fit(zone) || !is_inside(zone, kFirstSamples)) continue;
        const double time = outside + time_on(zone);
        if (!(time < best) || !is_inside(zone, kSamples) || !is_inside_at_kinks(zone)) continue;
        if (looks_behind_ && !leads_on(zone)) continue;
        best = time;
        found = zone;
      }
    }
    return found;
  }

  [[nodiscard]] double begin_at(double width) const noexcept {
    return place_.is_start ? place_.from : snapped(std::max(place_.from, place_.nearest - width));
  }
  [[nodiscard]] double end_at(double width) const noexcept {
    return place_.is_end ? place_.to : snapped(std::min(place_.to, place_.nearest + width));
  }
  [[nodiscard]] WristZone zone_of(double width) const noexcept {
    WristZone zone;
    zone.begin = begin_at(width);
    zone.end = end_at(width);
    zone.branch_before = place_.branch;
    return zone;
  }
  /// `u`, or the end of a span that is so close that the part between would be none.
  [[nodiscard]] double snapped(double u) const noexcept {
    const BandSpan& span = task_.spans.span_at(u);
    if (std::abs(u - span.u0) < kLeastPart_mm) return span.u0;
    const double end = span.u0 + span.length;
    return std::abs(end - u) < kLeastPart_mm ? end : u;
  }

  /// Of the exact way, where a zone of the width `to` is narrower than one of `from`.
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
      const auto at = solve(task_.model, task_.tool_length_mm, pose, place_.branch, place_.joints);
      if (at.status == SolveStatus::kUnreachable) return kNever;
      sum += (to - from) / kSteps * slowness(task_.model, span, pose, at.q);
    }
    return sum;
  }

  /// The quintic through both ends.
  bool fit(WristZone& zone) noexcept {
    const double h = zone.end - zone.begin;
    if (!(h > 2 * kLeastPart_mm)) return false;
    JointVector reference = place_.joints;
    double from = reference[kRoll], a1 = 0, a2 = 0;  // a start: at rest where it is
    if (!place_.is_start) {
      if (!follow({place_.from, zone.begin, place_.branch, false}, reference)) return false;
      const auto in = solve(task_.model, task_.tool_length_mm, pose_of<Jet<2>>(task_, zone.begin),
                            zone.branch_before, reference);
      if (in.status != SolveStatus::kOk) return false;
      from = value_of(in.q[kRoll]);
      a1 = in.q[kRoll].derivative(1) * h;
      a2 = in.q[kRoll].derivative(2) * h * h;
      for (std::size_t i = 0; i < reference.size(); ++i) reference[i] = value_of(in.q[i]);
    }
    double to = from + 0.5 * a1, b1 = 0, b2 = 0;  // an end: comes to rest
    if (place_.is_end) {
      zone.branch_after = zone.branch_before;
    } else {
      const auto out = solve(task_.model, task_.tool_length_mm, pose_of<Jet<2>>(task_, zone.end),
                             zone.branch_after, reference);
      if (out.status != SolveStatus::kOk) return false;
      to = value_of(out.q[kRoll]);
      b1 = out.q[kRoll].derivative(1) * h;
      b2 = out.q[kRoll].derivative(2) * h * h;
    }
    if (!(std::abs(a2) < kMostBend_rad) || !(std::abs(b2) < kMostBend_rad)) return false;
    zone.roll = {
        from, from + a1 / 5, from + 0.4 * a1 + a2 / 20, to - 0.4 * b1 + b2 / 20, to - b1 / 5, to};
    reference_ = reference;
    return true;
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
      const auto there =
          solve(task_.model, task_.tool_length_mm, pose_of<double>(task_, at), way.branch, joints);
      if (there.status == SolveStatus::kUnreachable) return false;
      joints = there.q;
      const bool is_out = first_joint_outside_travel(task_.model, joints, kTravelMargin) >= 0;
      if (way.keeps_travel && is_out) return false;
    }
    return true;
  }

  /// Whether the exact way behind the zone keeps travel, as far as the place goes.
  [[nodiscard]] bool leads_on(const WristZone& zone) const noexcept {
    if (place_.is_end) return true;
    JointVector joints = reference_;
    joints[kRoll] = zone.roll.back();
    return follow({zone.end, place_.to, zone.branch_after, true}, joints);
  }

  /// Angle at `u` to the programmed axis; infinite where a joint leaves travel or the tip is off.
  [[nodiscard]] double off_at(const WristZone& zone, double u) const noexcept {
    const ToolPose pose = pose_of<double>(task_, u);
    const double roll = quintic_at(zone.roll, (u - zone.begin) / (zone.end - zone.begin));
    const auto at =
        solve_driven(task_.model, task_.tool_length_mm, pose, roll, zone.branch_before, reference_);
    if (at.status == SolveStatus::kUnreachable) return kNever;
    if (first_joint_outside_travel(task_.model, at.q, kTravelMargin) >= 0) return kNever;
    const ToolPose there = forward(task_.model, task_.tool_length_mm, at.q);
    if (!((there.tip - pose.tip).norm() <= kMostTipError_mm)) return kNever;
    return task_.is_exact ? angle_between(pose.axis, there.axis)
                          : task_.programmed.angle_to(u, there.axis);
  }

  bool is_within(WristZone& zone, double u) const noexcept {
    const double off = off_at(zone, u);
    zone.deviation_rad = std::max(zone.deviation_rad, off);
    return off <= kToleranceShare * task_.tolerance_rad;
  }
  bool is_inside(WristZone& zone, int samples) const noexcept {
    for (int k = 0; k <= samples; ++k) {
      if (!is_within(zone, zone.begin + (zone.end - zone.begin) * k / samples)) return false;
    }
    return true;
  }
  /// The same where the programmed axis turns sharply.
  bool is_inside_at_kinks(WristZone& zone) const noexcept {
    for (std::size_t n = 0; n < kink_count_; ++n) {
      const bool is_there = kinks_[n] > zone.begin && kinks_[n] < zone.end;
      if (is_there && !is_within(zone, kinks_[n])) return false;
    }
    return true;
  }

  [[nodiscard]] double time_on(const WristZone& zone) const noexcept {
    constexpr int kSteps = kSamples / 2;
    const double h = zone.end - zone.begin;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double t = (k + 0.5) / kSteps, u = zone.begin + t * h;
      const BandSpan& span = task_.spans.span_at(u);
      const auto pose = pose_of<Jet<3>>(span, u);
      const auto at = solve_driven(task_.model, task_.tool_length_mm, pose,
                                   free_at(zone.roll, t, h), zone.branch_before, reference_);
      sum += h / kSteps * slowness(task_.model, span, pose, at.q);
    }
    return sum;
  }

  const PoleTask& task_;
  const WristPlace& place_;
  std::array<double, kKinks> kinks_{};  // u
  std::size_t kink_count_ = 0;
  bool looks_behind_ = true;
  JointVector reference_{};  // at the begin of the zone that was fitted last
};

}  // namespace

WristZone find_wrist_zone(const PoleTask& task, const WristPlace& place) noexcept {
  return Search(task, place).run();
}

}  // namespace meridian
