// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/pole_zone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/joint_cells.hpp"
#include "service/core/planner/parabola.hpp"
#include "service/core/planner/pole_time.hpp"
#include "service/core/planner/pole_travel.hpp"

namespace meridian {
namespace {

constexpr int kWidths = 24;
constexpr double kLeastShare = 1e-3;  // narrowest half width over the widest
constexpr double kSkews[] = {0, 0.2, -0.2, 0.4, -0.4, 0.6, -0.6};
constexpr int kSamples = 96;
constexpr std::size_t kKinks = 192;
constexpr double kToleranceShare = 0.998;  // samples are not everywhere
constexpr double kMostBend = 1e3;          // rad: φ'' h² at an end, beyond it the end is no guide
constexpr double kLeastGain_s = 1e-3;
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLeastPart_mm = 1e-4;
constexpr double kSameWinding_rad = 0.5;

/// Largest value that a smooth function may have about the middle of three samples: there, or at
/// the top of the parabola through them.
double top_of(double left, double middle, double right) noexcept {
  const Parabola about(left, middle, right);
  return about.bend > 0 && middle >= left && middle >= right ? about.top() : middle;
}

class Search {
 public:
  Search(const PoleTask& task, const PolePlace& place) noexcept
      : task_(task),
        place_(place),
        free_(free_joint(task.model)),
        before_(task, place, -1),
        behind_(task, place, 1) {
    if (task.is_exact) return;  // there the smoothed axis counts, which has no kinks
    const double begin = place.core_begin - (place.is_start ? 0 : place.reach);
    const double end = place.core_end + (place.is_end ? 0 : place.reach);
    kink_count_ = task.programmed.find_kinks(begin, end, kinks_);
  }

  PoleZone run() noexcept {
    const WayBehind exact = place_.is_dwelling ? WayBehind{} : follow_exactly();
    const Levels levels = find_levels();
    for (std::size_t n = 0; n < levels.count; ++n) {
      least_carried_ = levels.of[n];
      const bool is_exact_kept = exact.keeps_travel && carried(place_.branch, exact);
      search(is_exact_kept);
      if (is_exact_kept || best_.end > best_.begin) return best_;
    }
    looks_behind_ = false;  // an unwinding may help
    search(!place_.is_dwelling);
    return best_;
  }

 private:
  /// Blocks that ways have to carry, the most first.
  struct Levels {
    static constexpr std::size_t kMost = 4;
    std::array<int, kMost> of{};
    std::size_t count = 0;
  };
  [[nodiscard]] Levels find_levels() const noexcept {
    Levels levels;
    for (int below = std::numeric_limits<int>::max(); levels.count + 1 < Levels::kMost;) {
      int next = 0;
      for (const AheadWay& way : place_.ahead) {
        if (way.carries < below) next = std::max(next, way.carries);
      }
      if (next == 0) break;
      levels.of[levels.count++] = below = next;
    }
    levels.of[levels.count++] = 0;  // whatever there is
    return levels;
  }

  /// Whether `way` on `branch` carries what is asked for now.
  [[nodiscard]] bool carried(int branch, const WayBehind& way) const noexcept {
    if (least_carried_ == 0 || !way.is_to_end) return true;
    for (const AheadWay& ahead : place_.ahead) {
      if (ahead.branch == branch && std::abs(ahead.free - way.free) < kSameWinding_rad) {
        return ahead.carries >= least_carried_;
      }
    }
    return false;
  }

  /// All candidates, against the exact way where there is one.
  void search(bool has_exact) noexcept {
    const int branches = branch_count(task_.model);
    best_time_ = has_exact ? exact_time() - kLeastGain_s : kNever;
    const bool is_inside_core = place_.is_start && place_.is_end;  // held, whatever the width
    for (int n = is_inside_core ? kWidths - 1 : 0; n < kWidths; ++n) {
      const double width = place_.reach * std::pow(kLeastShare, 1.0 * n / (kWidths - 1));
      for (const double skew : kSkews) {
        if (skew != 0 && (place_.is_start || place_.is_end)) continue;
        const double before = width * (1 - skew) / (1 + std::abs(skew));
        const double behind = width * (1 + skew) / (1 + std::abs(skew));
        PoleZone zone;
        zone.branch_before = place_.branch;
        zone.begin = place_.is_start ? place_.core_begin : snapped(place_.core_begin - before);
        zone.end = place_.is_end ? place_.core_end : snapped(place_.core_end + behind);
        const double outside =
            (place_.is_start ? 0 : before_.to(before)) + (place_.is_end ? 0 : behind_.to(behind));
        for (int branch = 0; branch < branches; ++branch) {
          zone.branch_after = branch;
          for (const int turns : turns_to_try()) try_zone(zone, turns, outside);
        }
      }
    }
  }

  /// Of the free joint behind the zone, beside the nearest winding: where that matters.
  [[nodiscard]] std::span<const int> turns_to_try() const noexcept {
    static constexpr std::array kTurns{0, 1, -1};
    const bool matters = least_carried_ > 0 && !task_.model.joints[free_].is_endless;
    return {kTurns.data(), matters ? kTurns.size() : 1};
  }

  [[nodiscard]] WayBehind follow_exactly() const noexcept {
    const double begin = place_.is_start ? place_.core_begin : place_.core_begin - place_.reach;
    return follow_behind(task_, place_, begin, place_.joints, place_.branch);
  }
  [[nodiscard]] bool leads_on(const PoleZone& zone) const noexcept {
    if (!looks_behind_ || place_.is_end) return true;
    JointVector joints = place_.joints;
    joints[free_] = zone.free.back();
    const WayBehind way = follow_behind(task_, place_, zone.end, joints, zone.branch_after);
    return way.keeps_travel && carried(zone.branch_after, way);
  }

  /// `u`, or the end of a span that is so close that the part between would be none.
  [[nodiscard]] double snapped(double u) const noexcept {
    const BandSpan& span = task_.spans.span_at(u);
    if (std::abs(u - span.u0) < kLeastPart_mm) return span.u0;
    const double end = span.u0 + span.length;
    return std::abs(end - u) < kLeastPart_mm ? end : u;
  }

  void try_zone(PoleZone zone, int turns, double outside) noexcept {
    if (!(outside < best_time_) || !fit(zone, turns) || !is_inside(zone, kSamples / 8)) return;
    const double time = outside + time_on(zone, best_time_ - outside);
    if (!(time < best_time_) || !is_inside(zone, kSamples) || !is_inside_at_kinks(zone) ||
        !leads_on(zone)) {
      return;
    }
    best_time_ = time;
    best_ = zone;
    best_.carries = least_carried_;
  }

  /// The quintic through both ends, the free joint turned by whole `turns` beside the nearest way.
  bool fit(PoleZone& zone, int turns) const noexcept {
    const double h = zone.end - zone.begin;
    JointVector reference = place_.joints;
    double from = reference[free_], a1 = 0, a2 = 0;  // a start: at rest where it is
    if (!place_.is_start) {
      reference[free_] = before_.free_near(place_.core_begin - zone.begin);
      const auto in = solve(task_.model, task_.tool_length_mm, pose_of<Jet<2>>(task_, zone.begin),
                            place_.branch, reference);
      if (in.status != SolveStatus::kOk) return false;
      for (int i = 0; i < kMaxJoints; ++i) reference[i] = value_of(in.q[i]);
      from = reference[free_];
      a1 = in.q[free_].derivative(1) * h;
      a2 = in.q[free_].derivative(2) * h * h;
    }
    double to = from + 0.5 * a1, b1 = 0, b2 = 0;  // an end: comes to rest
    if (place_.is_end) {
      zone.branch_after = place_.branch;
    } else {
      const auto out = solve(task_.model, task_.tool_length_mm, pose_of<Jet<2>>(task_, zone.end),
                             zone.branch_after, reference);
      if (out.status != SolveStatus::kOk) return false;
      to = value_of(out.q[free_]) + turns * kTurn_rad;
      b1 = out.q[free_].derivative(1) * h;
      b2 = out.q[free_].derivative(2) * h * h;
    }
    if (!(std::abs(a2) < kMostBend) || !(std::abs(b2) < kMostBend)) return false;
    zone.free = {
        from, from + a1 / 5, from + 0.4 * a1 + a2 / 20, to - 0.4 * b1 + b2 / 20, to - b1 / 5, to};
    return true;
  }

  /// Angle at the share `t` of the zone to the programmed axis; infinite where a joint leaves
  /// travel.
  [[nodiscard]] double off_at(const PoleZone& zone, double t) const noexcept {
    const double u = zone.begin + t * (zone.end - zone.begin);
    const ToolPose pose = pose_of<double>(task_, u);
    const auto at = solve_held(task_.model, task_.tool_length_mm, pose, quintic_at(zone.free, t));
    if (at.status == SolveStatus::kUnreachable) return kNever;
    if (first_joint_outside_travel(task_.model, at.q, kTravelMargin) >= 0) return kNever;
    const Vector3 axis = forward(task_.model, task_.tool_length_mm, at.q).axis;
    return task_.is_exact ? angle_between(pose.axis, axis) : task_.programmed.angle_to(u, axis);
  }

  /// Remembers the largest angle `off`; false where it leaves the tolerance.
  bool is_within(PoleZone& zone, double off) const noexcept {
    if (!(off <= kToleranceShare * task_.tolerance_rad)) return false;
    zone.deviation_rad = std::max(zone.deviation_rad, off);
    return true;
  }

  /// Tolerance and travel at `samples` places.
  bool is_inside(PoleZone& zone, int samples) const noexcept {
    double before = 0, last = 0;  // deviations
    for (int k = 0; k <= samples; ++k) {
      const double off = off_at(zone, 1.0 * k / samples);
      if (!is_within(zone, std::max(off, k < 2 ? 0.0 : top_of(before, last, off)))) return false;
      before = last;
      last = off;
    }
    return true;
  }

  /// The same where the programmed axis turns sharply: what smoothing takes of the tolerance there
  /// is too narrow for even places.
  bool is_inside_at_kinks(PoleZone& zone) const noexcept {
    for (std::size_t n = 0; n < kink_count_; ++n) {
      const double share = (kinks_[n] - zone.begin) / (zone.end - zone.begin);
      if (share > 0 && share < 1 && !is_within(zone, off_at(zone, share))) return false;
    }
    return true;
  }

  /// Counted no farther than `most`.
  [[nodiscard]] double time_on(const PoleZone& zone, double most) const noexcept {
    constexpr int kSteps = kSamples / 2;
    const double h = zone.end - zone.begin;
    double sum = 0;
    for (int k = 0; k < kSteps && sum <= most; ++k) {
      const double t = (k + 0.5) / kSteps, u = zone.begin + t * h;
      const BandSpan& span = task_.spans.span_at(u);
      const auto pose = pose_of<Jet<3>>(span, u);
      const auto held =
          solve_held(task_.model, task_.tool_length_mm, pose, free_at(zone.free, t, h));
      sum += h / kSteps * slowness(task_.model, span, pose, held.q);
    }
    return sum;
  }

  /// Of the way without a zone: at the core the free joint turns from one side to the other.
  [[nodiscard]] double exact_time() const noexcept {
    const auto exact_at = [this](double u) {
      return solve(task_.model, task_.tool_length_mm, pose_of<double>(task_, u), place_.branch, {})
          .q[free_];
    };
    const double turn = exact_at(place_.core_end + behind_.innermost()) -
                        exact_at(place_.core_begin - before_.innermost());
    return before_.whole() + behind_.whole() +
           std::abs(std::remainder(turn, 2 * std::numbers::pi)) /
               task_.model.joints[free_].limits.velocity;
  }

  const PoleTask& task_;
  const PolePlace& place_;
  int free_;
  OutsideTime before_, behind_;
  std::array<double, kKinks> kinks_{};  ///< u
  std::size_t kink_count_ = 0;
  double best_time_ = 0;
  PoleZone best_;
  bool looks_behind_ = true;
  int least_carried_ = 0;  ///< blocks that a way behind has to carry
};

}  // namespace

PoleZone find_pole_zone(const PoleTask& task, const PolePlace& place) noexcept {
  return Search(task, place).run();
}

FreeQuintic part_of(const FreeQuintic& whole, double from, double to) noexcept {
  const auto split = [](const FreeQuintic& values, double t, bool is_left) {
    FreeQuintic level = values, left{}, right{};
    for (std::size_t n = 0; n < 6; ++n) {
      left[n] = level[0];
      right[5 - n] = level[5 - n];
      for (std::size_t k = 0; k + n < 5; ++k) level[k] += (level[k + 1] - level[k]) * t;
    }
    return is_left ? left : right;
  };
  const FreeQuintic left = to < 1 ? split(whole, to, true) : whole;
  return from > 0 ? split(left, from / to, false) : left;
}

}  // namespace meridian
