// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"
#include "support/program_end.hpp"

namespace meridian::test {

/// Seeded programs that are meant to hurt a smoother: repeated points, steps of 1e-7 and 1e-4 mm,
/// exact reversals, right angles, pure rotations to 40 deg, 12 deg per 0.1 mm, noise, arcs of small
/// blocks, and 100 mm beside 0.02 mm. The first block is where the path starts.
class HostilePath {
 public:
  /// Tilts of the tool axis lie in [`low`, `high`] rad.
  HostilePath(std::uint32_t seed, double low = 0.1, double high = 0.9)
      : engine_(seed), low_(low), high_(high) {
    tilt_ = uniform(low, high);
    azimuth_ = uniform(-3, 3);
    tip_ = Vector3(uniform(-50, 50), uniform(-50, 50), uniform(-20, 20));
    put();
  }

  [[nodiscard]] std::vector<ClBlock> make(int sections) {
    for (int n = 0; n < sections; ++n) {
      if (uniform(0, 1) < 0.5) direction_ = direction();
      if (uniform(0, 1) < 0.3) feed_ = std::pow(10.0, uniform(0, 2));
      add_section(static_cast<int>(uniform(0, 11)));
    }
    return blocks_;
  }

  /// The same with its end.
  [[nodiscard]] std::vector<ClBlock> make_program(int sections) {
    auto blocks = make(sections);
    end_program(blocks);
    return blocks;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vector3 direction() {
    std::normal_distribution<double> normal;
    return Vector3(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  void tilt_by(double by) { tilt_ = std::clamp(tilt_ + by, low_, high_); }

  void put() {
    ClBlock block;
    block.sequence = blocks_.size();
    block.line = static_cast<std::uint32_t>(blocks_.size()) + 10;
    block.tip_mm = to_array(tip_);
    block.axis = {std::sin(tilt_) * std::cos(azimuth_), std::sin(tilt_) * std::sin(azimuth_),
                  std::cos(tilt_)};
    block.feed = feed_;
    block.feed_meaning = FeedMeaning::kTip;
    blocks_.push_back(block);
  }
  void step(const Vector3& by) {
    tip_ += by;
    put();
  }

  void add_section(int kind) {
    const int count = static_cast<int>(uniform(3, 25));
    const Vector3 back = tip_;
    switch (kind) {
      case 0:
        return step(direction_ * uniform(20, 100));
      case 1:
        for (int i = 0; i < 3; ++i) put();
        return;
      case 2:
        for (int i = 0; i < count; ++i) step(direction() * 1e-4);
        return;
      case 3:
        step(direction_ * std::pow(10.0, uniform(-3, 1)));
        return step(back - tip_);
      case 4:  // pure rotation
        azimuth_ += uniform(-0.7, 0.7);
        tilt_by(uniform(-0.3, 0.3));
        return put();
      case 5:  // 12 deg in 0.1 mm
        for (int i = 0; i < 4; ++i) {
          azimuth_ += 0.2 / std::max(0.2, std::sin(tilt_));
          step(direction_ * 0.1);
        }
        return;
      case 6:
        return add_arc(count * 4);
      case 7:
        for (int i = 0; i < count / 2; ++i) {
          direction_ = direction_.cross(direction()).normalized();
          step(direction_ * std::pow(10.0, uniform(-2, 1)));
        }
        return;
      case 8:
        for (int i = 0; i < count; ++i) {
          azimuth_ += (i % 2 == 0 ? 1 : -1) * uniform(0.002, 0.05);
          step(direction_ * uniform(0.01, 1));
        }
        return;
      case 9:
        step(direction_ * uniform(1e-7, 0.01));
        return step(direction_ * uniform(10, 80));
      default:
        for (int i = 0; i < count; ++i) {
          tilt_by(uniform(-0.005, 0.005));
          step(direction_ * uniform(0.05, 1.5) + direction() * 0.002);
        }
    }
  }

  void add_arc(int count) {
    const double radius = uniform(0.5, 20), turn = uniform(0.01, 0.4) / radius;
    const double noise = uniform(0, 1) < 0.5 ? 0 : 1e-3;
    const Vector3 across = direction_.unitOrthogonal(), centre = tip_ + radius * across;
    for (int i = 1; i < count; ++i) {
      azimuth_ += 0.002;
      const double a = turn * i;
      tip_ =
          centre + radius * (std::sin(a) * direction_ - std::cos(a) * across) + noise * direction();
      put();
    }
  }

  std::mt19937 engine_;
  double low_, high_;
  double tilt_ = 0, azimuth_ = 0, feed_ = 50;
  Vector3 tip_, direction_ = Vector3::UnitX();
  std::vector<ClBlock> blocks_;
};

}  // namespace meridian::test
