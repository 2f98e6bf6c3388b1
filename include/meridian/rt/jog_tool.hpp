// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/rt/jog_room.hpp"

/// Jogging in the frame of the tool: along its axis, across it, or turning it
/// about its tip. The way is surveyed before anything moves, a few places in
/// each cycle; it ends where joints do not follow it evenly any more (travel,
/// reach, the pole) and is as slow as its steepest place asks for. Frame: W.
/// Units: mm, rad, s. RT: cycle. Proof: tests/property/rt/jog_tool_test.cpp.
namespace meridian {

/// z points from the tip to the shank. x is W's x made normal to it (W's y
/// where the tool points along x), y = z × x. Tilts are about x and y.
enum class ToolAxis : std::uint8_t { kX, kY, kZ, kTiltX, kTiltY };
inline constexpr int kToolAxisCount = 5;

/// One hold goes no farther: behind it the way is surveyed anew.
inline constexpr double kToolWay_mm = 100, kToolWay_rad = 0.5;

/// A way of the tool as a function of s: tip + s·along, or, tilting, the axis
/// on a great circle.
struct ToolWay {
  Array3 tip{}, axis{0, 0, 1};
  Array3 direction{};  ///< unit: of the tip, or of the axis
  bool is_tilt = false;
  std::uint8_t branch = 0;
  double tool_length_mm = 0;
};

template <class S>
[[nodiscard]] inline Pose<S> pose_on(const ToolWay& way, const S& s) noexcept {
  Pose<S> pose;
  const SinCos<S> turn = sin_cos(way.is_tilt ? s : S(0.0));
  for (std::size_t i = 0; i < 3; ++i) {
    pose.tip[i] = way.is_tilt ? S(way.tip[i]) : S(way.tip[i] + s * way.direction[i]);
    pose.axis[i] =
        way.is_tilt ? S(turn.cos * way.axis[i] + turn.sin * way.direction[i]) : S(way.axis[i]);
  }
  return pose;
}

/// The joints at `s`, in the windings nearest to `reference`; not kOk: do not
/// use them.
template <class S>
[[nodiscard]] inline Solution<S> joints_on(const MachineModel& machine, const ToolWay& way,
                                           const S& s, const JointVector& reference) noexcept {
  Solution<S> at = solve(machine, way.tool_length_mm, pose_on(way, s), way.branch, reference);
  // Where the axis stands still the pole holds nobody up.
  if (at.status == SolveStatus::kAtPole && !way.is_tilt) at.status = SolveStatus::kOk;
  return at;
}

/// `v` made a unit vector. Eigen's own are no calls for the cycle: they are not noexcept.
[[nodiscard]] inline Array3 unit_of(const Array3& v) noexcept {
  const double per = 1 / std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] * per, v[1] * per, v[2] * per};
}

/// Lays a way through where the tool is; false where no solution of the inverse
/// kinematics gives the joints back.
[[nodiscard]] inline bool lay_way(const MachineModel& machine, const JointVector& joints,
                                  double tool_length_mm, ToolAxis direction,
                                  ToolWay& way) noexcept {
  constexpr double kSameJoints = 1e-6;
  const ToolPose pose = forward(machine, tool_length_mm, joints);
  const Array3 z = unit_of({pose.axis[0], pose.axis[1], pose.axis[2]});
  // W's x, or y, without its part along z.
  const std::size_t k = std::abs(z[0]) < 0.9 ? 0 : 1;
  Array3 x{-z[k] * z[0], -z[k] * z[1], -z[k] * z[2]};
  x[k] += 1;
  x = unit_of(x);
  const Array3 y{z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
  way.tip = {pose.tip[0], pose.tip[1], pose.tip[2]};
  way.axis = z;
  way.is_tilt = direction >= ToolAxis::kTiltX;
  way.tool_length_mm = tool_length_mm;
  switch (direction) {
    case ToolAxis::kX:
    case ToolAxis::kTiltY:  // about y, z turns towards x
      way.direction = x;
      break;
    case ToolAxis::kY:
      way.direction = y;
      break;
    case ToolAxis::kZ:
      way.direction = z;
      break;
    case ToolAxis::kTiltX:  // about x, z turns towards -y
      way.direction = {-y[0], -y[1], -y[2]};
      break;
  }
  for (int branch = 0; branch < branch_count(machine); ++branch) {
    way.branch = static_cast<std::uint8_t>(branch);
    const Solution<double> at = joints_on(machine, way, 0.0, joints);
    double apart = 0;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      apart = std::max(apart, std::abs(at.q[i] - joints[i]));
    }
    if (at.status == SolveStatus::kOk && apart <= kSameJoints) return true;
  }
  return false;
}

/// What is known of a way so far, from its middle outwards, first to one side,
/// then to the other.
class ToolSurvey {
 public:
  ToolSurvey() = default;
  ToolSurvey(const MachineModel& machine, const ToolWay& way, const JointVector& joints,
             double distance) noexcept {
    const double whole = way.is_tilt ? kToolWay_rad : kToolWay_mm;
    step_ = std::min(distance > 0 ? distance : whole, whole) / kSteps;
    is_over_ = !look(machine, way, 0, joints, middle_);
    last_ = middle_;
    if (!is_over_) keep(machine, middle_);
  }

  [[nodiscard]] bool is_over() const noexcept { return is_over_; }

  /// Looks at the next places.
  void go_on(const MachineModel& machine, const ToolWay& way) noexcept {
    constexpr int kPlaces = 2;
    for (int n = 0; n < kPlaces && !is_over_; ++n) {
      Place next;
      const double s = (is_back_ ? -1 : 1) * (steps_ + 1) * step_;
      const bool goes_on = look(machine, way, s, values_of(last_), next) &&
                           is_even(machine, last_, next) && steps_ < kSteps;
      if (goes_on) {
        keep(machine, next);
        last_ = next;
        (is_back_ ? low_ : high_) = s;
        ++steps_;
      } else if (!is_back_) {
        is_back_ = true;
        steps_ = 0;
        last_ = middle_;
      } else {
        is_over_ = !look_closer();
      }
    }
  }

  /// After it: the way as an axis at its middle, with rates that hold all
  /// along.
  [[nodiscard]] JogRoom room(const MachineModel& machine, const ToolWay& way) const noexcept {
    JogRoom room;
    room.axis.low = low_;
    room.axis.high = high_;
    const JogRates most =
        way.is_tilt ? JogRates{10, 1e3, 1e5} : JogRates{machine.max_feed_mm_per_s, 1e5, 1e7};
    room.axis.rates = room.fault = most;
    for (int i = 0; i < limited_count(machine); ++i) {
      const JointLimits& limits = limited_spec(machine, i).limits;
      const jog::Slopes& slopes = slopes_[static_cast<std::size_t>(i)];
      jog::keep_drive(room.axis.rates, slopes, kJogShare * limits.velocity,
                      kJogShare * limits.acceleration, kJogShare * limits.jerk);
      jog::keep_drive(room.fault, slopes, kJogShare * limits.velocity,
                      kJogShare * limits.fault_acceleration, kJogShare * limits.fault_jerk);
    }
    return room;
  }

 private:
  static constexpr int kSteps = 32;
  using Place = Limited<Jet<3>>;

  [[nodiscard]] static JointVector values_of(const Place& place) noexcept {
    JointVector q{};
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = value_of(place[i]);
    return q;
  }

  /// Beside the pole: a shorter way may be even where the whole one is not.
  /// False where that was tried, or is not needed.
  [[nodiscard]] bool look_closer() noexcept {
    constexpr double kCloser = 1.0 / 16;
    if (low_ < 0 || high_ > 0 || ++closer_ > 2) return false;
    step_ *= kCloser;
    is_back_ = false;
    steps_ = 0;
    last_ = middle_;
    return true;
  }

  /// False where no joints are there, or outside of travel.
  [[nodiscard]] static bool look(const MachineModel& machine, const ToolWay& way, double s,
                                 const JointVector& reference, Place& place) noexcept {
    const auto at = joints_on(machine, way, Jet<3>::variable(s), reference);
    if (at.status != SolveStatus::kOk) return false;
    place = limited_of(machine, at.q);
    for (int i = 0; i < limited_count(machine); ++i) {
      if (!is_inside_travel(limited_spec(machine, i), value_of(place[static_cast<std::size_t>(i)]),
                            0)) {
        return false;
      }
    }
    return !has_stage(machine) || stage::is_in_reach(machine.stage, values_of(place));
  }

  /// Whether what is known at two neighbouring places explains how they differ:
  /// nothing steep hides between them.
  [[nodiscard]] bool is_even(const MachineModel& machine, const Place& a,
                             const Place& b) const noexcept {
    constexpr double kShare = 0.1, kRounding = 1e-9;
    const double h = is_back_ ? -step_ : step_;
    for (int i = 0; i < limited_count(machine); ++i) {
      const auto n = static_cast<std::size_t>(i);
      const auto larger = [&](int order) {
        return std::max(std::abs(a[n].derivative(order)), std::abs(b[n].derivative(order)));
      };
      const double third = std::max(larger(3), slopes_[n].third);
      const std::array<double, 3> curves{std::abs(h) * larger(1) + h * h * larger(2),
                                         std::abs(h) * larger(2) + h * h * third,
                                         std::abs(h) * third};
      for (int order = 0; order < 3; ++order) {
        const double change = b[n].derivative(order) - a[n].derivative(order);
        const double explained =
            0.5 * h * (a[n].derivative(order + 1) + b[n].derivative(order + 1));
        const double allowed = kShare * curves[static_cast<std::size_t>(order)] + kRounding;
        if (!(std::abs(change - explained) <= allowed)) return false;
      }
    }
    return true;
  }

  void keep(const MachineModel& machine, const Place& place) noexcept {
    constexpr double kBetween = 1.15, kStraight = 1e-11;
    for (int i = 0; i < limited_count(machine); ++i) {
      const auto n = static_cast<std::size_t>(i);
      const auto raise = [](double& most, double value) {
        if (std::abs(value) > kStraight) most = std::max(most, kBetween * std::abs(value));
      };
      raise(slopes_[n].first, place[n].derivative(1));
      raise(slopes_[n].second, place[n].derivative(2));
      raise(slopes_[n].third, place[n].derivative(3));
    }
  }

  double step_ = 0, low_ = 0, high_ = 0;
  int steps_ = 0, closer_ = 0;
  bool is_back_ = false, is_over_ = true;
  Place middle_{}, last_{};
  std::array<jog::Slopes, kMaxLimited> slopes_{};
};

}  // namespace meridian
