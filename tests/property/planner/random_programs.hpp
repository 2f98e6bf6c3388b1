// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/units.hpp"

/// Programs that look for trouble: at, beside and through the pole, reversals, pure rotations,
/// blocks of nothing and of a tenth of a micrometre, feeds from crawl to absurd.
namespace meridian::test {

class RandomPrograms {
 public:
  explicit RandomPrograms(std::uint64_t seed) : engine_(seed) {}

  [[nodiscard]] double uniform(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(engine_);
  }
  [[nodiscard]] double log_uniform(double low, double high) {
    return low * std::pow(high / low, uniform(0, 1));
  }
  [[nodiscard]] bool chance(double p) { return uniform(0, 1) < p; }

  /// Tool axis by tilt and azimuth about the pole of the machine, seen from its workpiece frame. A
  /// stage turns by less than a quarter turn either way: azimuths are drawn together for it.
  [[nodiscard]] static Vector3 axis_of(const MachineModel& model, double tilt, double azimuth) {
    if (has_stage(model)) azimuth -= 0.4 * std::remainder(azimuth, std::numbers::pi);
    const Vector3 in_machine(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                             std::cos(tilt));
    return model.X_MW.rotation.transpose() * in_machine;
  }

  /// A rotation of the workpiece by up to `most` rad about any axis.
  [[nodiscard]] Eigen::Matrix3d rotation(double largest) {
    const Vector3 about = Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    const double angle = uniform(-largest, largest), c = std::cos(angle), s = std::sin(angle);
    Eigen::Matrix3d cross;
    cross << 0, -about[2], about[1], about[2], 0, -about[0], -about[1], about[0], 0;
    return Eigen::Matrix3d::Identity() + s * cross + (1 - c) * cross * cross;
  }

  [[nodiscard]] std::vector<ClBlock> program(const MachineModel& model, int length) {
    std::vector<ClBlock> out;
    Vector3 tip(uniform(-200, 200), uniform(-200, 200), uniform(-50, 50));
    double tilt = draw_tilt(), azimuth = uniform(-3.2, 3.2);
    const int habit = static_cast<int>(uniform(0, 4));
    for (int n = 0; n < length; ++n) {
      const std::uint64_t sequence = out.size();
      ClBlock block;
      if (n > 0) {
        const int what = static_cast<int>(uniform(0, 10));
        if (what == 0 && out.size() >= 2) {  // back to where the block before began
          block = out[out.size() - 2];
        } else if (what > 1) {  // 1: the same place again
          if (what != 2) tip += draw_step(habit);
          if (what != 3) turn_axis(tilt, azimuth, habit);
        }
      }
      if (block.kind != BlockKind::kCut || block.sequence == 0) block = {};
      const bool is_back = block.feed > 0;
      if (!is_back) {
        block.tip_mm = to_array(tip);
        block.axis = to_array(axis_of(model, tilt, azimuth));
      }
      block.is_arc = false;
      set_feed(block);
      if (n > 0 && !is_back && chance(0.1)) make_arc(out.back(), block, tip);
      block.sequence = sequence;
      block.line = static_cast<std::uint32_t>(10 * sequence + 7);
      out.push_back(block);
      if (is_back) tip = to_vector(block.tip_mm);
    }
    return out;
  }

  [[nodiscard]] JointVector start(const MachineModel& model) {
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) {
      const bool is_endless = model.joints[i].is_endless;
      const JointLimits& limits = model.joints[i].limits;
      q[i] =
          is_endless ? uniform(-20, 20) : uniform(0.8 * limits.travel_min, 0.8 * limits.travel_max);
    }
    if (chance(0.2)) q[4] = 0;
    return q;
  }

 private:
  [[nodiscard]] double draw_tilt() {
    const double kind = uniform(0, 1);
    if (kind < 0.1) return 0;
    if (kind < 0.35) return units::rad_from_deg(log_uniform(1e-12, 1));
    return units::rad_from_deg(uniform(0, 59));
  }

  [[nodiscard]] Vector3 draw_step(int habit) {
    const double length =
        habit == 0 ? log_uniform(1e-5, 1e-2) : (chance(0.1) ? 1e-4 : log_uniform(1e-3, 150));
    return length * Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-0.3, 0.3)).normalized();
  }

  void turn_axis(double& tilt, double& azimuth, int habit) {
    if (habit == 1) {  // across the pole or nearly so
      azimuth += std::numbers::pi + (chance(0.3) ? 0.0 : log_uniform(1e-14, 0.5));
      if (chance(0.5)) tilt = draw_tilt();
    } else if (habit == 2) {  // in and out
      tilt = tilt == 0 ? uniform(0.05, 1) : 0;
      azimuth += uniform(0, 1) < 0.5 ? std::numbers::pi / 6 * std::floor(uniform(0, 7)) : 0.0;
    } else if (habit == 3) {
      tilt = draw_tilt();
      azimuth += uniform(-3, 3);
    } else {
      tilt = std::min(1.0, std::abs(tilt + uniform(-1e-3, 1e-3)));
      azimuth += uniform(-1e-2, 1e-2);
    }
  }

  void set_feed(ClBlock& block) {
    const double kind = uniform(0, 1);
    if (kind < 0.15) {
      block.kind = BlockKind::kRapid;
      return;
    }
    if (kind < 0.3) {
      block.feed_meaning = FeedMeaning::kInverseTime;
      block.feed = log_uniform(0.01, 100);
      return;
    }
    block.feed_meaning = FeedMeaning::kTip;
    block.feed = log_uniform(0.01, 2000);
  }

  void make_arc(const ClBlock& before, ClBlock& block, Vector3& tip) {
    const Vector3 normal =
        Vector3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(0.5, 1)).normalized();
    const Vector3 begin = to_vector(before.tip_mm);
    const Vector3 any(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    const Vector3 radius = log_uniform(0.1, 50) * (any - normal * normal.dot(any)).normalized();
    block.is_arc = true;
    block.centre_mm = to_array(begin - radius);
    block.normal = to_array(normal);
    block.sweep_rad = uniform(0.01, 2 * std::numbers::pi);
    const double c = std::cos(block.sweep_rad), s = std::sin(block.sweep_rad);
    const Vector3 y(normal[1] * radius[2] - normal[2] * radius[1],
                    normal[2] * radius[0] - normal[0] * radius[2],
                    normal[0] * radius[1] - normal[1] * radius[0]);
    tip = begin - radius + c * radius + s * y + uniform(-5, 5) * normal;
    block.tip_mm = to_array(tip);
  }

  std::mt19937_64 engine_;
};

}  // namespace meridian::test
