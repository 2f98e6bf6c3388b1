// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "meridian/geometry/vector3.hpp"

namespace meridian::test {

/// Seeded poses for property tests: tips in a cube of 800 mm, tool axes in turn anywhere within 60°
/// of +z, near the pole (1e-1 to 1e-12 rad off), and exactly on it.
class RandomPoses {
 public:
  explicit RandomPoses(std::uint32_t seed) : engine_(seed) {}

  [[nodiscard]] double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  [[nodiscard]] ToolPose next() {
    double tilt = 0;
    switch (count_++ % 3) {
      case 0:
        tilt = uniform(0, std::numbers::pi / 3);
        break;
      case 1:
        tilt = std::pow(10.0, uniform(-12, -1));
        break;
      default:
        break;
    }
    return pose_with_tilt(tilt);
  }

  [[nodiscard]] ToolPose pose_with_tilt(double tilt) {
    const double azimuth = uniform(-std::numbers::pi, std::numbers::pi);
    const Vector3 tip(uniform(-400, 400), uniform(-400, 400), uniform(-400, 400));
    return {
        tip,
        {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)}};
  }

 private:
  std::mt19937 engine_;
  std::uint64_t count_ = 0;
};

}  // namespace meridian::test
