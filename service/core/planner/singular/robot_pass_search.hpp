// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/singular/pole_time.hpp"
#include "service/core/planner/singular/robot_pass.hpp"

namespace meridian {

/// The search behind find_robot_pass(): candidates (robot_pass.cpp), joints that are turned at rest
/// (robot_pass_turned.cpp), and what a candidate has to keep (robot_pass_checks.cpp).
class RobotPassSearch {
 public:
  RobotPassSearch(const PassTask& task, const PassRange& range) noexcept;
  /// Nothing: a pass with no length.
  RobotPass run() noexcept;

 private:
  static constexpr int kSamples = 96, kFirstSamples = 12;
  static constexpr std::size_t kKinks = 192;
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  [[nodiscard]] static bool is_pass(const RobotPass& pass) noexcept {
    return pass.end > pass.begin;
  }
  [[nodiscard]] static std::size_t joint_of(Singularity at) noexcept {
    return at == Singularity::kShoulder ? std::size_t{robot::kYaw} : std::size_t{robot::kRoll};
  }
  [[nodiscard]] const PassEnds& ends_of(Singularity at) const noexcept {
    return range_.ends[index_of(at)];
  }
  /// Whether the joint is driven, and then follows the path.
  [[nodiscard]] bool comes_out(Singularity at) const noexcept {
    return drives(range_.at, at) && ends_of(at).to == PassEnd::kOnPath;
  }
  /// Whether a driven joint rests at that end.
  [[nodiscard]] bool rests_at(PassEnd PassEnds::*end) const noexcept;

  // Candidates.
  [[nodiscard]] RobotPass search() noexcept;
  [[nodiscard]] bool is_narrow(const RobotPass& pass) const noexcept;
  [[nodiscard]] RobotPass pass_over(double width) const noexcept;
  [[nodiscard]] double begin_at(double width) const noexcept;
  [[nodiscard]] double end_at(double width) const noexcept;
  /// `u`, or the end of a span that is so close that the part between would be none.
  [[nodiscard]] double snapped(double u) const noexcept;
  /// Of the exact way, where a pass of the width `to` is narrower than one of `from`.
  [[nodiscard]] double time_beside(double from, double to) const noexcept;
  [[nodiscard]] double time_exactly(double from, double to) const noexcept;
  [[nodiscard]] double time_on(const RobotPass& pass) const noexcept;

  /// A driven joint at an end, with two derivatives by the share of the pass.
  struct Slope {
    double value = 0, rate = 0, bend = 0;
  };
  using Slopes = std::array<Slope, kSingularities>;
  [[nodiscard]] static FreeQuintic quintic_of(const Slope& a, const Slope& b) noexcept;
  /// Quintics of all driven joints through both ends.
  bool fit(RobotPass& pass) noexcept;
  /// Sets those of joints that do not rest at the end to the exact path; those that rest have their
  /// value.
  bool find_slopes(const RobotPass& pass, PassEnd PassEnds::*end, Slopes& slopes) const noexcept;
  /// `value`, or the winding of it inside travel.
  [[nodiscard]] double inside_travel(std::size_t joint, double value) const noexcept;

  // Turned at rest.
  /// By how much the joints of both places are to rest elsewhere, rad.
  using Turned = std::array<double, kSingularities>;
  [[nodiscard]] static double largest_of(const Turned& by) noexcept {
    return std::max(std::abs(by[0]), std::abs(by[1]));
  }
  /// Where a joint that rests leads others out of their travel: passes after which it rests at
  /// another value, some of them so short that it turns next to standstill.
  [[nodiscard]] RobotPass search_turned() noexcept;
  /// Where joints rest as nothing leads out of the singular place: a short pass that turns them to
  /// where they are after it.
  [[nodiscard]] RobotPass search_turned_off() noexcept;
  [[nodiscard]] RobotPass turned_off(const Turned& turned) noexcept;
  /// What joints may be turned by, the smallest turn first.
  static constexpr std::size_t kMaxTurns = 9;
  struct Turns {
    std::array<Turned, kMaxTurns> by{};
    std::size_t count = 0;
  };
  [[nodiscard]] Turns turns_off() const noexcept;
  void add_turn(const JointVector& there, Turns& turns) const noexcept;
  /// Yaws that lead the wrist point straight from the begin of the range to its end: that nearer to
  /// `yaw`.
  [[nodiscard]] double straight_yaw(double yaw) const noexcept;
  /// Whether, after a pass that turned both joints at rest, one leads out of both places.
  [[nodiscard]] bool is_led_out(const RobotPass& pass) const noexcept;
  /// Whether the wrist is within that angle of in line at the begin of the range, with that yaw.
  [[nodiscard]] bool is_in_line(double yaw, double within_rad) const noexcept;
  /// A turn of the yaw towards `by` that ends where the wrist comes into line, if it does.
  [[nodiscard]] double stopped_in_line(double by) const noexcept;

  // Checks.
  /// A stretch of the exact path.
  struct Stretch {
    double from = 0, to = 0;
    int branch = 0;
    bool keeps_travel = false;
  };
  /// Follows the joints to its end; false: there are none there, or they leave travel.
  [[nodiscard]] bool follow(const Stretch& way, JointVector& joints) const noexcept;
  /// Whether the exact path after the pass keeps travel, as far as the range goes.
  [[nodiscard]] bool leads_on(const RobotPass& pass) const noexcept;
  /// Whether the driven joints may rest after the pass as far as the range goes.
  [[nodiscard]] bool rests_on(const RobotPass& pass) const noexcept;
  /// How far the tool is off the programmed path, as the pass may be.
  struct Off {
    double tip_mm = kNever, axis_rad = kNever;
  };
  /// Infinite where a joint leaves travel.
  [[nodiscard]] Off off_at(const RobotPass& pass, double u) const noexcept;
  bool is_within(RobotPass& pass, double u) const noexcept;
  bool is_inside(RobotPass& pass, int samples) const noexcept;
  /// The same where the programmed axis turns sharply.
  bool is_inside_at_kinks(RobotPass& pass) const noexcept;
  template <class S>
  [[nodiscard]] Solution<S> solve_on(const RobotPass& pass, const Pose<S>& pose, const S& joint,
                                     const S& roll) const noexcept {
    return solve_driven(task_.model, task_.tool_length_mm, pose, joint, roll,
                        driven_branch(range_.at, pass.branch_before), reference_);
  }

  const PassTask& task_;
  PassRange range_;
  bool drives_yaw_, drives_roll_;
  std::array<double, kKinks> kinks_{};  // u
  std::size_t kink_count_ = 0;
  bool looks_behind_ = true;
  Turned turned_{};          // joints that are to rest elsewhere
  JointVector reference_{};  // at the begin of the pass that was fitted last
};

}  // namespace meridian
