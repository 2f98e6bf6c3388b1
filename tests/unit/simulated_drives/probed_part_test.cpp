// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/probed_part.hpp"

#include <gtest/gtest.h>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/machines.hpp"

namespace meridian::drives {
namespace {

constexpr double kExact_mm = 1e-9;

constexpr const char* kPart = R"(length_mm = 120
ball_radius_mm = 3
[[box]]
origin_mm = [10, 0, 0]
rotation_deg = [0, 0, 90]
size_mm = [40, -20, -10]
[[sphere]]
origin_mm = [-100, 0, 0]
radius_mm = 12
[[bore]]
origin_mm = [0, 200, 0]
radius_mm = 20
depth_mm = 30
)";

TEST(ProbedPart, IsReadFromItsFile) {
  const ProbedPart part = parse_probed_part(kPart, "part.toml");
  EXPECT_EQ(part.length_mm, 120);
  EXPECT_EQ(part.ball_mm, 3);
  ASSERT_EQ(part.shapes.size(), 3U);
  EXPECT_EQ(part.shapes[0].size_mm, Vector3(40, -20, -10));
  EXPECT_LT((part.shapes[0].rotation.col(0) - Vector3::UnitY()).norm(), kExact_mm);
  EXPECT_EQ(part.shapes[1].radius_mm, 12);
  EXPECT_EQ(part.shapes[2].depth_mm, 30);
  EXPECT_THROW((void)parse_probed_part("ball_radius_mm = 3\n", "part.toml"), config::ConfigError);
  EXPECT_THROW(
      (void)parse_probed_part("length_mm = 1\nball_radius_mm = 3\nbocks = 1\n", "part.toml"),
      config::ConfigError);
}

TEST(ProbedPart, KnowsTheDistanceToEachOfItsShapes) {
  const ProbedPart part = parse_probed_part(kPart, "part.toml");
  const auto distance = [&part](std::size_t shape, const Vector3& point) {
    return distance_to(part.shapes[shape], point);
  };
  // The box reaches from x 10 to 30 and from y 0 to 40.
  EXPECT_NEAR(distance(0, {5, 20, -5}), 5, kExact_mm);
  EXPECT_NEAR(distance(0, {20, 20, 7}), 7, kExact_mm);
  EXPECT_NEAR(distance(0, {7, -4, -5}), 5, kExact_mm) << "of an edge";
  EXPECT_NEAR(distance(0, {20, 20, -2}), -2, kExact_mm) << "inside";
  EXPECT_NEAR(distance(1, {-100, 0, 20}), 8, kExact_mm);
  EXPECT_NEAR(distance(2, {15, 200, -10}), 5, kExact_mm);
  EXPECT_NEAR(distance(2, {24, 200, 50}), 50, kExact_mm) << "above the wall of the bore";
  EXPECT_NEAR(distance(2, {20, 200, -34}), 4, kExact_mm) << "below it";
  EXPECT_NEAR(distance(2, {40, 200, -10}), 10, kExact_mm) << "outside of it";
  EXPECT_LE(distance(2, {25, 200, -10}), 0) << "in it";
}

TEST(ProbedPart, IsTouchedByTheBallWhereTheDrivesAre) {
  const MachineModel machine = test::lai_machine();
  ProbedPart part;
  part.length_mm = 120;
  part.ball_mm = 3;
  const JointVector joints{10, -5, 30, 0.2, 0.3};
  const ToolPose pose = forward(machine, part.length_mm, joints);
  ProbedShape sphere;
  sphere.kind = ProbedShape::Kind::kSphere;
  sphere.radius_mm = 4;
  sphere.origin_mm = pose.tip + 3 * pose.axis + Vector3(0, 17, 0);
  part.shapes.push_back(sphere);
  const SimulatedProbe probe(part, machine);
  EXPECT_NEAR(probe.distance(drives_of(machine, joints)), 10, kExact_mm);
}

}  // namespace
}  // namespace meridian::drives
