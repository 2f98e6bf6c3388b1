// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "meridian/planner/time_law.hpp"
#include "service/core/planner/feed/cells/feed_limits.hpp"

/// A stop along a path, from its begin to rest, and how much of the joints' limits it uses.
namespace meridian::test {

/// The machine's limits of its joints, with no room for the rate of plan time.
[[nodiscard]] inline FeedLimits joint_limits(const MachineModel& machine) {
  FeedLimits limits;
  limits.count = machine.joint_count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(limits.count); ++i) {
    const JointLimits& joint = machine.joints[i].limits;
    limits.velocity[i] = joint.velocity;
    limits.acceleration[i] = joint.acceleration;
    limits.jerk[i] = limits.full_jerk[i] = joint.jerk;
  }
  return limits;
}

/// b = ds² over the path length since the begin, a quadratic between knots; the last stretch is
/// landed by a constant jerk.
class StopMotion {
 public:
  /// The next knot, its b and db/ds.
  void add(double s, double b, double slope) {
    s_.push_back(s);
    b_.push_back(b);
    slope_.push_back(slope);
    if (s_.size() > 1) time_s_ += time_of(s_.size() - 2);
  }
  /// From the last knot to rest at `length`, with the constant jerk that its speed asks for.
  void land(double length) {
    length_ = length;
    time_s_ += landing_s();
  }

  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] double length() const { return length_; }
  /// Stretches between knots; the landing is one more.
  [[nodiscard]] std::size_t stretches() const { return s_.size() - 1; }

  [[nodiscard]] double b_at(double s) const {
    const double v = s < s_.back() ? at(stretch_of(s), s).ds : landing_at(s).ds;
    return v * v;
  }
  /// The state at a share of a stretch.
  [[nodiscard]] PathState state(std::size_t stretch, double share) const {
    if (stretch + 1 == s_.size()) return landing_at(s_.back() + share * (length_ - s_.back()));
    return at(stretch, s_[stretch] + share * (s_[stretch + 1] - s_[stretch]));
  }

 private:
  [[nodiscard]] std::size_t stretch_of(double s) const {
    return static_cast<std::size_t>(std::upper_bound(s_.begin() + 1, s_.end() - 1, s) -
                                    s_.begin()) -
           1;
  }
  [[nodiscard]] PathState at(std::size_t k, double s) const {
    const double bend = (slope_[k + 1] - slope_[k]) / (s_[k + 1] - s_[k]), x = s - s_[k];
    const double v = std::sqrt(std::max(0.0, b_[k] + x * (slope_[k] + x * bend / 2)));
    return {s, v, 0.5 * (slope_[k] + x * bend), 0.5 * bend * v};
  }
  /// ds = j t²/2 with t to go: the length is j t³/6.
  [[nodiscard]] double landing_s() const {
    return 3 * (length_ - s_.back()) / std::sqrt(b_.back());
  }
  [[nodiscard]] PathState landing_at(double s) const {
    const double whole = landing_s(), jerk = 2 * std::sqrt(b_.back()) / (whole * whole);
    const double t = std::cbrt(6 * std::max(0.0, length_ - s) / jerk);
    return {s, 0.5 * jerk * t * t, -jerk * t, jerk};
  }
  /// By Simpson's rule on 1/√b in eight parts.
  [[nodiscard]] double time_of(std::size_t k) const {
    constexpr int kParts = 8;
    double sum = 0;
    for (int i = 0; i <= kParts; ++i) {
      const double weight = i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2;
      sum += weight / state(k, static_cast<double>(i) / kParts).ds;
    }
    return sum * (s_[k + 1] - s_[k]) / (3 * kParts);
  }

  std::vector<double> s_, b_, slope_;
  double length_ = 0, time_s_ = 0;
};

/// Largest shares of the limits of any joint.
struct StopUse {
  double velocity = 0, acceleration = 0, jerk = 0;
  [[nodiscard]] double max() const { return std::max({velocity, acceleration, jerk}); }

  template <class Jets>
  void take(const FeedLimits& limits, const Jets& q, const PathState& m) {
    const double v = m.ds, a = m.dds, j = m.ddds;
    for (std::size_t i = 0; i < static_cast<std::size_t>(limits.count); ++i) {
      const double d1 = q[i].derivative(1), d2 = q[i].derivative(2), d3 = q[i].derivative(3);
      velocity = std::max(velocity, std::abs(d1 * v) / limits.velocity[i]);
      acceleration = std::max(acceleration, std::abs(d1 * a + d2 * v * v) / limits.acceleration[i]);
      jerk = std::max(jerk, std::abs(d1 * j + 3 * d2 * v * a + d3 * v * v * v) / limits.jerk[i]);
    }
  }
};

/// What the joints do on `motion`, at 500 instants or more of it. `path` gives the joints in jets
/// at path lengths that grow, `begin` at the begin of the stop.
template <class Path>
[[nodiscard]] StopUse use_of(const FeedLimits& limits, const StopMotion& motion, double begin,
                             Path path) {
  const std::size_t samples = 1 + 500 / (motion.stretches() + 1);
  StopUse use;
  for (std::size_t k = 0; k <= motion.stretches(); ++k) {
    for (std::size_t i = 0; i < samples; ++i) {
      const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(samples);
      const PathState at = motion.state(k, share);
      use.take(limits, path(begin + at.s), at);
    }
  }
  return use;
}

}  // namespace meridian::test
