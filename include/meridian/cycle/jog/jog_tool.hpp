// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/jog/jog_path.hpp"
#include "meridian/cycle/jog/jog_room.hpp"
#include "meridian/geometry/jet.hpp"
#include "meridian/kinematics/keep_out.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tip_over_base.hpp"

/// Jogging in the frame of the tool: along its axis, across it, or turning it
/// about its tip. The way is surveyed before anything moves, a few points in
/// each cycle; it ends where joints do not follow it evenly any more (travel,
/// reach, the pole) and is as slow as its steepest place asks for. Frame: W.
/// Units: mm, rad, s. RT: cycle. Proof: tests/property/cycle/jog_tool_test.cpp.
namespace meridian {

/// What is known of a way so far, from its middle outwards, first to one side,
/// then to the other. A joint, or drive of a stage, that stands outside of
/// travel comes no farther out; where the way leads it in, it does not lead
/// back.
class ToolSurvey {
 public:
  ToolSurvey() = default;
  ToolSurvey(const MachineModel& machine, const ToolPath& tool_path, const JointVector& joints,
             double distance) noexcept {
    const double whole = tool_path.is_tilt ? kToolPath_rad : kToolPath_mm;
    step_ = std::min(distance > 0 ? distance : whole, whole) / kSteps;
    is_over_ = !look(machine, tool_path, 0, joints, middle_);
    last_ = middle_;
    if (!is_over_) keep(machine, middle_);
  }

  [[nodiscard]] bool is_over() const noexcept { return is_over_; }

  /// Looks at the next points.
  void go_on(const MachineModel& machine, const ToolPath& tool_path) noexcept {
    constexpr int kSamples = 2;
    for (int n = 0; n < kSamples && !is_over_; ++n) {
      Sample next;
      const double s = (is_back_ ? -1 : 1) * (steps_ + 1) * step_;
      const bool goes_on = look(machine, tool_path, s, values_of(last_), next) &&
                           is_even(machine, last_, next) && stays_in(machine, last_, next) &&
                           keeps_tip_in(machine, tool_path.tool_length_mm, last_, next) &&
                           steps_ < kSteps;
      if (goes_on) {
        keep(machine, next);
        const bool is_in = comes_in(machine, last_, next) ||
                           brings_tip_in(machine, tool_path.tool_length_mm, last_, next);
        if (is_in) (is_back_ ? last_out_ : first_in_) = s;
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
  [[nodiscard]] JogRoom room(const MachineModel& machine,
                             const ToolPath& tool_path) const noexcept {
    JogRoom room;
    room.axis.low = first_in_ > 0 ? first_in_ : low_;
    room.axis.high = last_out_ < 0 && !(first_in_ > 0) ? last_out_ : high_;
    const JogRates max =
        tool_path.is_tilt ? JogRates{10, 1e3, 1e5} : JogRates{machine.max_feed_mm_per_s, 1e5, 1e7};
    room.axis.rates = room.fault = max;
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
  /// mm or rad; of joints that stand still or at an end of travel, less than kGuardOutside.
  static constexpr double kRounding = 5e-12;
  using Sample = Limited<Jet<3>>;

  [[nodiscard]] static JointVector values_of(const Sample& sample) noexcept {
    JointVector q{};
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = value_of(sample[i]);
    return q;
  }

  /// Beside the pole: a shorter way may be even where the whole one is not.
  /// False where that was tried, or is not needed.
  [[nodiscard]] bool look_closer() noexcept {
    constexpr double kCloser = 1.0 / 16;
    constexpr int kRounds = 4;  // down to some 3e-6 rad beside the pole
    if (low_ < 0 || high_ > 0 || ++closer_ > kRounds) return false;
    step_ *= kCloser;
    is_back_ = false;
    steps_ = 0;
    last_ = middle_;
    return true;
  }

  /// False where no joints are there.
  [[nodiscard]] static bool look(const MachineModel& machine, const ToolPath& tool_path, double s,
                                 const JointVector& reference, Sample& sample) noexcept {
    const auto at = joints_on(machine, tool_path, Jet<3>::variable(s), reference);
    if (at.status != SolveStatus::kOk) return false;
    sample = limited_of(machine, at.q);
    return true;
  }

  /// How far `at` is outside of travel.
  [[nodiscard]] static double out_of(const JointSpec& spec, double at) noexcept {
    if (spec.is_endless) return 0;
    return std::max({0.0, spec.limits.travel_min - at, at - spec.limits.travel_max});
  }
  /// How deep `at` is inside of `box`.
  [[nodiscard]] static double inside_of(const KeepOutBox& box, const Sample& at) noexcept {
    return std::max(0.0, depth_inside(box, values_of(at)));
  }
  /// The same of the angle of the stage.
  [[nodiscard]] static double phi_out_of(const MachineModel& machine, const Sample& at) noexcept {
    const double phi = stage::carriage_of(machine.stage, values_of(at)).phi;
    return std::max(0.0, std::abs(phi) - machine.stage.phi_max_rad);
  }

  /// Whether a joint or drive that is outside of travel at `a` is farther in at
  /// its neighbour `b`.
  [[nodiscard]] static bool comes_in(const MachineModel& machine, const Sample& a,
                                     const Sample& b) noexcept {
    for (int i = 0; i < limited_count(machine); ++i) {
      const JointSpec& spec = limited_spec(machine, i);
      const auto n = static_cast<std::size_t>(i);
      if (out_of(spec, value_of(a[n])) - out_of(spec, value_of(b[n])) > kRounding) return true;
    }
    for (const KeepOutBox& box : machine.keep_out.boxes()) {
      if (inside_of(box, a) - inside_of(box, b) > kKeepOutRounding) return true;
    }
    return has_stage(machine) && phi_out_of(machine, a) - phi_out_of(machine, b) > kRounding;
  }

  /// Whether no joint or drive is farther outside of travel between `a` and its
  /// even neighbour `b`, and there, than at `a`.
  [[nodiscard]] bool stays_in(const MachineModel& machine, const Sample& a,
                              const Sample& b) const noexcept {
    constexpr double kPeak = 0.75;  // of a parabola 0.5
    const double h = is_back_ ? -step_ : step_;
    for (int i = 0; i < limited_count(machine); ++i) {
      const JointSpec& spec = limited_spec(machine, i);
      const auto n = static_cast<std::size_t>(i);
      const double at = value_of(a[n]), begin = h * a[n].derivative(1),
                   end = h * b[n].derivative(1);
      const bool turns = begin * end < 0;
      const double peak = turns ? at + kPeak * begin * begin / (begin - end) : at;
      const double max = std::max(out_of(spec, value_of(b[n])), out_of(spec, peak));
      if (max - out_of(spec, at) > kRounding) return false;
    }
    if (!machine.keep_out.empty() && !keeps_out(machine, a, b)) return false;
    return !has_stage(machine) || phi_out_of(machine, b) - phi_out_of(machine, a) <= kRounding;
  }

  /// The same of the keep-out boxes.
  [[nodiscard, gnu::noinline]] bool keeps_out(const MachineModel& machine, const Sample& a,
                                              const Sample& b) const noexcept {
    constexpr double kBend = 0.25;  // of h² times the second derivative; of a parabola an eighth
    const JointVector from = values_of(a), to = values_of(b);
    JointVector off{};
    for (std::size_t i = 0; i < off.size(); ++i) {
      const double bend = std::max(std::abs(a[i].derivative(2)), std::abs(b[i].derivative(2)));
      off[i] = kBend * step_ * step_ * bend;
    }
    for (const KeepOutBox& box : machine.keep_out.boxes()) {
      const double before = depth_inside(box, from);
      const bool stays = before > kKeepOutRounding ? depth_inside(box, to) <= before + kRounding
                                                   : entry_share(box, from, to, off) > 1;
      if (!stays) return false;
    }
    return true;
  }

  /// The tip over the base, with its derivatives along the way.
  [[nodiscard]] static std::array<Jet<3>, 3> tip_at(const MachineModel& machine,
                                                    double tool_length_mm,
                                                    const Sample& at) noexcept {
    Joints<Jet<3>> q;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = at[i];
    return tip_over_base(machine, tool_length_mm, q);
  }

  /// Whether the tip is nowhere farther outside of its box between `a` and `b`, and there, than at
  /// `a`.
  [[nodiscard, gnu::noinline]] bool keeps_tip_in(const MachineModel& machine, double tool_length_mm,
                                                 const Sample& a, const Sample& b) const noexcept {
    constexpr double kBend = 2;  // of the second derivative at both ends
    if (!machine.tip_box.is_set) return true;
    const std::array<Jet<3>, 3> from = tip_at(machine, tool_length_mm, a),
                                to = tip_at(machine, tool_length_mm, b);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double bend = std::max(std::abs(from[i].derivative(2)), std::abs(to[i].derivative(2)));
      const TipStep step{value_of(from[i]), value_of(to[i]), from[i].derivative(1),
                         to[i].derivative(1), kBend * bend};
      const double before = beyond_face(machine.tip_box, i, step.from);
      const double out = beyond_over_step(machine.tip_box, i, step, step_);
      if (!(out <= std::max(kTipBoxRounding, before + kRounding))) return false;
    }
    return true;
  }

  /// Whether a tip that is outside of its box at `a` is farther in at its neighbour `b`.
  [[nodiscard, gnu::noinline]] static bool brings_tip_in(const MachineModel& machine,
                                                         double tool_length_mm, const Sample& a,
                                                         const Sample& b) noexcept {
    if (!machine.tip_box.is_set) return false;
    const std::array<Jet<3>, 3> from = tip_at(machine, tool_length_mm, a),
                                to = tip_at(machine, tool_length_mm, b);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double before = beyond_face(machine.tip_box, i, value_of(from[i]));
      const double after = beyond_face(machine.tip_box, i, value_of(to[i]));
      if (before > kTipBoxRounding && before - std::max(0.0, after) > kTipBoxRounding) return true;
    }
    return false;
  }

  /// Whether what is known at two neighbouring points explains how they differ:
  /// nothing steep hides between them.
  [[nodiscard]] bool is_even(const MachineModel& machine, const Sample& a,
                             const Sample& b) const noexcept {
    constexpr double kShare = 0.1, kEqual = 1e-9;
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
        const double allowed = kShare * curves[static_cast<std::size_t>(order)] + kEqual;
        if (!(std::abs(change - explained) <= allowed)) return false;
      }
    }
    return true;
  }

  void keep(const MachineModel& machine, const Sample& sample) noexcept {
    constexpr double kBetween = 1.15, kStraight = 1e-11;
    for (int i = 0; i < limited_count(machine); ++i) {
      const auto n = static_cast<std::size_t>(i);
      const auto raise = [](double& max, double value) {
        if (std::abs(value) > kStraight) max = std::max(max, kBetween * std::abs(value));
      };
      raise(slopes_[n].first, sample[n].derivative(1));
      raise(slopes_[n].second, sample[n].derivative(2));
      raise(slopes_[n].third, sample[n].derivative(3));
    }
  }

  double step_ = 0, low_ = 0, high_ = 0;
  double first_in_ = 0, last_out_ = 0;  ///< the way that leads inwards ends there; 0: none does
  int steps_ = 0, closer_ = 0;
  bool is_back_ = false, is_over_ = true;
  Sample middle_{}, last_{};
  std::array<jog::Slopes, kMaxLimited> slopes_{};
};

}  // namespace meridian
