// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/path_choice.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/stop_product.hpp"

namespace meridian {
namespace {

constexpr double kAuthority = 0.9;
constexpr double kUnlimited = 1e12;  // a path along which no joint moves has no limit of its own
/// Third differences are checked down to this cycle time.
constexpr double kShortestCycle_s = 250e-6;

void set_noise_gain(const MachineModel& model, double reach_mm, JointCaps& caps) noexcept {
  const double gain =
      noise_gain(std::min(kShortestCycle_s, static_cast<double>(model.cycle_ns) * 1e-9));
  for (int i = 0; i < model.joint_count; ++i) {
    if (!model.joints[i].is_rotary) caps.noise_gain[i] = gain * reach_mm;
  }
  if (const int free = redundant_joint(model); free >= 0) caps.noise_gain[free] = gain;
  for (int i = model.joint_count; i < limited_count(model); ++i) {
    caps.noise_gain[i] = gain * (reach_mm + stage::lever_mm(model.stage));
  }
}

/// Whether the curvature terms at `velocity` leave kAuthority of what rest would allow.
bool leaves_authority(std::span<const JointCell> cells, const JointCaps& caps, double velocity,
                      double rest_accel, double rest_jerk) noexcept {
  const double accel = find_acceleration(cells, caps, velocity);
  if (accel < kAuthority * rest_accel) return false;
  const double used = std::min(accel, std::sqrt(velocity * rest_jerk));
  return find_jerk(cells, caps, velocity, used) >= kAuthority * rest_jerk;
}

MotionChoice try_velocity(std::span<const JointCell> cells, const JointCaps& caps, double length,
                          double velocity, double rest_jerk) noexcept {
  MotionChoice choice;
  const double accel =
      std::min(find_acceleration(cells, caps, velocity), std::sqrt(velocity * rest_jerk));
  if (!(accel > 0)) return choice;
  const double jerk = find_jerk(cells, caps, velocity, accel);
  if (!(jerk > 0)) return choice;
  choice.limits = {velocity, accel, jerk};
  choice.profile = rest_to_rest_with_reserve(length, choice.limits);
  return choice;
}

void keep_faster(const MotionChoice& other, MotionChoice& best) noexcept {
  if (other.profile.jerk == 0) return;
  if (best.profile.jerk == 0 || other.profile.duration() < best.profile.duration()) best = other;
}

}  // namespace

JointCaps planned_caps(const MachineModel& model, double reach_mm) noexcept {
  JointCaps caps;
  caps.count = limited_count(model);
  for (int i = 0; i < caps.count; ++i) {
    const JointLimits& limits = limited_spec(model, i).limits;
    caps.velocity[i] = kPlannedShare * limits.velocity;
    caps.acceleration[i] = kPlannedShare * limits.acceleration;
    caps.jerk[i] = kPlannedShare * limits.jerk;
  }
  set_noise_gain(model, reach_mm, caps);
  return caps;
}

JointCaps fault_caps(const MachineModel& model, double reach_mm) noexcept {
  JointCaps caps = planned_caps(model, reach_mm);
  for (int i = 0; i < caps.count; ++i) {
    const JointLimits& limits = limited_spec(model, i).limits;
    const double accel = std::max(limits.fault_acceleration, limits.acceleration);
    const double jerk = std::max(limits.fault_jerk, limits.jerk);
    caps.acceleration[i] = kPlannedShare * accel;
    caps.jerk[i] = kPlannedShare * jerk;
  }
  return caps;
}

double find_acceleration(std::span<const JointCell> cells, const JointCaps& caps,
                         double velocity) noexcept {
  const double square = velocity * velocity;
  double accel = kUnlimited;
  for (const JointCell& cell : cells) {
    for (int i = 0; i < caps.count; ++i) {
      const double left = caps.acceleration[i] - cell.d2[i] * square;
      if (!(left < accel * cell.d1[i])) continue;
      if (left < 0) return left;
      accel = left / cell.d1[i];
    }
  }
  return accel;
}

double find_jerk(std::span<const JointCell> cells, const JointCaps& caps, double velocity,
                 double acceleration) noexcept {
  return find_jerk_beside(cells, caps, velocity, velocity * acceleration);
}

double find_jerk_beside(std::span<const JointCell> cells, const JointCaps& caps, double velocity,
                        double product) noexcept {
  const double cube = velocity * velocity * velocity;
  const double mixed = 3 * product;
  double jerk = kUnlimited;
  for (const JointCell& cell : cells) {
    for (int i = 0; i < caps.count; ++i) {
      const double left = caps.jerk[i] - caps.noise_gain[i] * cell.noise_rad - cell.d3[i] * cube -
                          cell.d2[i] * mixed;
      if (!(left < jerk * cell.d1[i])) continue;
      if (left < 0) return left;
      jerk = left / cell.d1[i];
    }
  }
  return jerk;
}

MotionChoice choose_motion(std::span<const JointCell> cells, const JointCaps& caps, double length,
                           double feed_velocity) noexcept {
  const double rest_accel = find_acceleration(cells, caps, 0);
  const double rest_jerk = find_jerk(cells, caps, 0, 0);
  MotionChoice best;
  if (!(rest_accel > 0) || !(rest_jerk > 0)) return best;
  double velocity = std::min({feed_velocity, kUnlimited, 0.5 * rest_accel / kRateSlope_per_s,
                              0.25 * rest_jerk / kRateCurvature_per_s2});
  for (const JointCell& cell : cells) {
    for (int i = 0; i < caps.count; ++i) {
      if (caps.velocity[i] < velocity * cell.d1[i]) velocity = caps.velocity[i] / cell.d1[i];
    }
  }
  if (!leaves_authority(cells, caps, velocity, rest_accel, rest_jerk)) {
    double low = 0, high = velocity;
    for (int n = 0; n < 12; ++n) {
      const double middle = 0.5 * (low + high);
      (leaves_authority(cells, caps, middle, rest_accel, rest_jerk) ? low : high) = middle;
    }
    velocity = low > 0 ? low : high / 4096;
  }
  for (const double share : {1.0, 0.75, 0.5}) {
    const bool is_too_slow =
        best.profile.jerk > 0 && length > share * velocity * best.profile.duration();
    if (is_too_slow) break;
    keep_faster(try_velocity(cells, caps, length, share * velocity, rest_jerk), best);
  }
  // A short way does not reach its velocity: a lower one costs less curvature.
  for (int n = 0; n < 2 && best.profile.jerk > 0; ++n) {
    const double reached = 1.002 * best.profile.peak_velocity();
    if (reached > 0.98 * best.limits.velocity) break;
    keep_faster(try_velocity(cells, caps, length, reached, rest_jerk), best);
  }
  return best;
}

PathLimits find_authority(std::span<const JointCell> cells, const JointCaps& caps,
                          const StopRange& range) noexcept {
  const double rest_jerk = find_jerk(cells, caps, range.velocity, 0);
  // The deepest deceleration d of a stop: d² = j v + a²/2, and that is j times the peak of v.
  const double needed =
      1.01 * std::sqrt(std::max(0.0, range.velocity * rest_jerk) + 0.5 * range.fall * range.fall);
  const double accel = std::min(find_acceleration(cells, caps, range.velocity),
                                std::max(needed, range.acceleration));
  const double product = largest_stop_product(range.top, accel, rest_jerk);
  return {range.velocity, accel, find_jerk_beside(cells, caps, range.velocity, product)};
}

}  // namespace meridian
