// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "meridian/units.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// A stretch with a vertical tool between tilted ones: the commonest way onto the pole and off it.
namespace meridian::test {
namespace {

constexpr double kFeed_mm_per_s = 20;
constexpr double kTurns_s = 3;  // for the tilts, and half a turn of C

ClBlock block_to(int n, double x_mm, const Vector3& axis) {
  ClBlock block = cut_block(n, {Vector3(x_mm, 20, 10), axis.normalized()});
  block.feed = kFeed_mm_per_s;
  return block;
}

/// The tool is vertical along `length_mm`, but for `off` of its axis.
std::vector<ClBlock> along_the_pole(double length_mm, double off) {
  const Vector3 vertical(-off, -1.26 * off, 1);
  std::vector<ClBlock> blocks = {block_to(0, 20, {0.35, 0.44, 0.82}), block_to(1, 20, vertical),
                                 block_to(2, 20 + length_mm, vertical),
                                 block_to(3, 21 + length_mm, {-0.35, -0.49, 0.79})};
  end_program(blocks);
  return blocks;
}

TEST(VerticalTool, IsLedOntoThePoleAndOffItOnEveryMachine) {
  for (const std::string& name : cases(shipped_machines())) {
    const MachineModel model = config::load_machine(shipped_file(name));
    if (redundant_joint(model) < 0) continue;  // a robot's singularities lie elsewhere
    for (const double length_mm : cases({2.0, 25.0, 100.0})) {
      for (const double off : cases({0.0, 1e-8, 1e-4})) {
        SCOPED_TRACE(name + ", " + std::to_string(length_mm) + " mm, " + std::to_string(off));
        const auto blocks = along_the_pole(length_mm, off);
        const SmoothTrace trace = plan_smooth(model, blocks, joints_of(model, blocks[0]));
        EXPECT_EQ(trace.last.status, PlanStatus::kOk) << static_cast<int>(trace.last.reject.code);
        EXPECT_LT(trace.duration_s(), length_mm / kFeed_mm_per_s + kTurns_s);
      }
    }
  }
}

/// A run from rest to rest that is shorter than the gaps between the knots of C's way.
TEST(VerticalTool, MayBeTiltedByLittleOnARunOfMicrometres) {
  for (const std::string& name : cases(shipped_machines())) {
    const MachineModel model = config::load_machine(shipped_file(name));
    if (redundant_joint(model) < 0) continue;
    for (const double length_mm : {0.002, 0.02, 0.2, 2.0}) {
      SCOPED_TRACE(name + ", " + std::to_string(length_mm) + " mm");
      std::vector<ClBlock> blocks = {block_to(0, 20, {0, 0, 1}),
                                     block_to(1, 20 + 0.5 * length_mm, {2e-4, 1e-4, 1}),
                                     block_to(2, 20 + length_mm, {6e-4, 2e-4, 1})};
      end_program(blocks);
      const SmoothTrace trace = plan_smooth(model, blocks, joints_of(model, blocks[0]));
      EXPECT_EQ(trace.last.status, PlanStatus::kOk) << static_cast<int>(trace.last.reject.code);
      EXPECT_LT(trace.duration_s(), 1 + length_mm / kFeed_mm_per_s);
    }
  }
}

/// The axis runs about the pole, `tilt_deg` beside it, by turns of the redundant joint that are
/// wider than the corridor; then the tool is vertical, and rests.
std::vector<ClBlock> from_a_circle(double tilt_deg, double step_deg, double step_mm) {
  const double tilt = units::rad_from_deg(tilt_deg), step = units::rad_from_deg(step_deg);
  constexpr int kSteps = 16;
  std::vector<ClBlock> blocks;
  const auto add = [&](const Vector3& axis) {
    const int n = static_cast<int>(blocks.size());
    blocks.push_back(block_to(n, 20 + step_mm * n, axis));
  };
  for (int n = 0; n <= kSteps; ++n) {
    add({std::sin(tilt) * std::cos(step * n), std::sin(tilt) * std::sin(step * n), std::cos(tilt)});
  }
  for (int n = 0; n < 4; ++n) add({0, 0, 1});
  end_program(blocks);
  return blocks;
}

TEST(VerticalTool, IsLedOntoThePoleFromCirclesAboutIt) {
  double largest = 0;
  for (const std::string& name : cases(shipped_machines())) {
    const MachineModel model = config::load_machine(shipped_file(name));
    if (redundant_joint(model) < 0) continue;
    for (const double tilt_deg : cases({0.5, 1.0, 2.2, 4.0})) {
      for (const double step_deg : cases({4.0, 12.0, 25.0})) {
        for (const double step_mm : cases({0.1, 0.5})) {
          SCOPED_TRACE(testing::Message() << name << ", " << tilt_deg << " deg, " << step_deg
                                          << " deg, " << step_mm << " mm");
          const auto blocks = from_a_circle(tilt_deg, step_deg, step_mm);
          const SmoothTrace trace = plan_smooth(model, blocks, joints_of(model, blocks[0]));
          EXPECT_EQ(trace.last.status, PlanStatus::kOk) << static_cast<int>(trace.last.reject.code);
          const auto setpoints = sample(model, trace, 1e-3, 0.37, joints_of(model, blocks[0]));
          const LimitUse use = measure_limits(model, setpoints, 1e-3);
          EXPECT_LE(std::max({use.v, use.a, use.j}), 1 + 1e-6) << use.where;
          largest = std::max({largest, use.v, use.a, use.j});
        }
      }
    }
  }
  std::printf("%.6f of the limits\n", largest);
}

/// A vertical tool by the numbers of a CAM system, some seconds of arc off the pole: the cut that
/// leads off from it passed the pole on its own azimuth, C by 176 deg in 4.1 s.
TEST(VerticalTool, LeadsOffFromBesideThePoleNoSlowerThanInExactStop) {
  const MachineModel model = config::load_machine(shipped_file("trunnion-bc"));
  for (const double lean : {1e-6, 2e-5, 1e-4, 2e-4, 3e-4}) {
    for (const double azimuth : {1.0, 2.5, 4.0}) {
      SCOPED_TRACE(std::to_string(lean) + " at " + std::to_string(azimuth));
      const double tilt = units::rad_from_deg(25);
      const Vector3 vertical = Vector3(lean * std::cos(azimuth), lean * std::sin(azimuth), 1);
      const Vector3 tilted(0.6 * std::sin(tilt), 0.8 * std::sin(tilt), std::cos(tilt));
      std::vector<ClBlock> blocks = {cut_block(0, {Vector3(0, 0, 30), vertical.normalized()}),
                                     cut_block(1, {Vector3(20, 0, 30), vertical.normalized()}),
                                     cut_block(2, {Vector3(40, 0, 30), tilted})};
      for (ClBlock& block : blocks) block.feed = 40;
      end_program(blocks);
      const auto seconds = [&](Transition how) {
        const SmoothTrace trace =
            plan_smooth(model, blocks, joints_of(model, blocks[0]), {how, 0, 0});
        EXPECT_EQ(trace.last.status, PlanStatus::kOk);
        return trace.duration_s();
      };
      EXPECT_LE(seconds(Transition::kSmooth), seconds(Transition::kExactStop) + 0.005);
    }
  }
}

}  // namespace
}  // namespace meridian::test
