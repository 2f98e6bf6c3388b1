// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/touch_off.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::inspect {
namespace {

constexpr double kBall_mm = 3, kFlat_mm = 5, kLength_mm = 110;
constexpr double kExact_mm = 1e-8;  // 1e3 mm * eps = 2e-13; the iteration ends at 1e-10

MachineModel mill() {
  return config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
}

Eigen::Matrix3d turned(double a_deg, double b_deg, double c_deg) {
  return config::rotation_from_deg(a_deg, b_deg, c_deg);
}

/// A workpiece whose faces lie at 0 of the axes of `rotation` at `origin`, and who touches it.
struct Part {
  MachineModel machine = mill();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vector3 origin = Vector3::Zero();

  /// Touches at `point` of the part the face that looks along `axis` of it, upright, with a ball.
  [[nodiscard]] Touch ball(const Vector3& point, int axis, double sign = 1) const {
    const Vector3 normal = sign * rotation.col(axis);
    const Vector3 centre = origin + rotation * point + kBall_mm * normal;
    Touch touch = at(centre - Vector3(0, 0, kBall_mm));
    touch.radius_mm = kBall_mm;
    touch.is_ball = true;
    touch.toward = -sign * machine.X_MW.rotation.col(axis);
    return touch;
  }
  /// The tool upright with its tip there.
  [[nodiscard]] Touch at(const Vector3& tip) const {
    Touch touch;
    touch.tool_length_mm = kLength_mm;
    const Vector3 from = pose_of(touch, machine).tip;
    for (int i = 0; i < 3; ++i) touch.joints[static_cast<std::size_t>(i)] = tip[i] - from[i];
    EXPECT_LT((pose_of(touch, machine).tip - tip).norm(), 1e-9);
    return touch;
  }
  void expect_found(const Expected<FoundFrame, std::string>& found) const {
    ASSERT_TRUE(found) << found.error();
    EXPECT_LT((found->origin_mm - origin).norm(), kExact_mm) << found->arithmetic;
    EXPECT_LT((found->rotation - rotation).norm(), 1e-10) << found->arithmetic;
  }
};

TEST(TouchOff, OfACornerTouchedThreeTwoOnceFindsAnyTiltOfIt) {
  std::mt19937_64 engine(20261127);
  std::uniform_real_distribution<double> tilt(-8, 8), coordinate(-100, 100), on(5, 60);
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE(n);
    Part part;
    part.rotation = turned(tilt(engine), tilt(engine), tilt(engine));
    part.origin = Vector3(coordinate(engine), coordinate(engine), coordinate(engine));
    const std::vector<Touch> touches{part.ball({5, 5, 0}, 2),
                                     part.ball({5 + on(engine), 6, 0}, 2),
                                     part.ball({7, 5 + on(engine), 0}, 2),
                                     part.ball({5, 0, -10}, 1, -1),
                                     part.ball({15 + on(engine), 0, -12}, 1, -1),
                                     part.ball({0, on(engine), -11}, 0, -1)};
    part.expect_found(find_frame(TouchedShape::kCorner, touches, part.machine));
  }
}

TEST(TouchOff, OfThreeFacesOnceEachMovesTheOriginAlone) {
  Part part;
  part.rotation = part.machine.X_MW.rotation = turned(0, 0, 30);
  part.origin = Vector3(12, -7, 40);
  part.expect_found(find_frame(
      TouchedShape::kCorner,
      {part.ball({5, 0, -3}, 1, -1), part.ball({0, 9, -3}, 0, -1), part.ball({4, 4, 0}, 2)},
      part.machine));
}

TEST(TouchOff, OfAFaceTakesOffTheRadiusOfAFlankAndNothingOfATip) {
  Part part;
  part.machine.X_MW.origin_mm = Vector3(1, 2, 3);
  Touch flank = part.at({50 - kFlat_mm, 20, 10});
  flank.radius_mm = kFlat_mm;
  flank.toward = Vector3::UnitX();
  const auto side = find_frame(TouchedShape::kFace, {flank}, part.machine);
  ASSERT_TRUE(side) << side.error();
  EXPECT_LT((side->origin_mm - Vector3(50, 2, 3)).norm(), kExact_mm);
  Touch tip = part.at({50, 20, 10});
  tip.radius_mm = kFlat_mm;
  tip.toward = -Vector3::UnitZ();
  const auto top = find_frame(TouchedShape::kFace, {tip}, part.machine);
  ASSERT_TRUE(top) << top.error();
  EXPECT_LT((top->origin_mm - Vector3(1, 2, 10)).norm(), kExact_mm);
  EXPECT_NE(top->arithmetic.find("tip 50.0000 20.0000 10.0000 mm"), std::string::npos);
}

TEST(TouchOff, OfAnEdgeTurnsTheFrameAboutZ) {
  Part part;
  part.rotation = turned(0, 0, 4);
  part.origin = Vector3(0, 0, 0);
  part.expect_found(find_frame(TouchedShape::kEdge,
                               {part.ball({5, 0, -3}, 1, -1), part.ball({60, 0, -3}, 1, -1)},
                               part.machine));
}

TEST(TouchOff, OfAPlaneTiltsTheFrameAndKeepsXNear) {
  Part part;
  part.rotation = turned(2, -3, 0);
  const auto found = find_frame(
      TouchedShape::kPlane,
      {part.ball({5, 5, 0}, 2), part.ball({60, 6, 0}, 2), part.ball({7, 50, 0}, 2)}, part.machine);
  ASSERT_TRUE(found) << found.error();
  EXPECT_LT((found->rotation.col(2) - part.rotation.col(2)).norm(), 1e-10);
  const Vector3 x = found->rotation.col(0);
  EXPECT_LT(std::abs(x.cross(Vector3::UnitX()).dot(part.rotation.col(2))), 1e-10)
      << "x stays above the x of before";
  EXPECT_GT(x.x(), 0.99);
  EXPECT_LT(std::abs((found->origin_mm - part.origin).dot(part.rotation.col(2))), kExact_mm);
}

TEST(TouchOff, OfABoreFindsItsMiddleFromThreeTouchesAndItsErrorFromFour) {
  Part part;
  part.machine.X_MW.origin_mm = Vector3(1, 2, 3);
  constexpr double kBore_mm = 20;
  const auto touch = [&](double angle, double off_mm = 0) {
    const Vector3 out(std::cos(angle), std::sin(angle), 0);
    Touch t = part.at(Vector3(30, 40, 5) + (kBore_mm - kBall_mm + off_mm) * out);
    t.radius_mm = kBall_mm;
    t.toward = out;
    return t;
  };
  const auto three =
      find_frame(TouchedShape::kBore, {touch(0.1), touch(2), touch(4)}, part.machine);
  ASSERT_TRUE(three) << three.error();
  EXPECT_LT((three->origin_mm - Vector3(30, 40, 3)).norm(), kExact_mm);
  EXPECT_NE(three->arithmetic.find("bore of 40.0000 mm"), std::string::npos) << three->arithmetic;
  const auto four = find_frame(
      TouchedShape::kBore, {touch(0), touch(1.57, 0.02), touch(3.14), touch(4.71)}, part.machine);
  ASSERT_TRUE(four) << four.error();
  EXPECT_GT(four->residual_mm, 0.004);
  EXPECT_LT(four->residual_mm, 0.006);
}

TEST(TouchOff, SaysWhichTouchesAreMissing) {
  const Part part;
  const Touch top = part.ball({5, 5, 0}, 2), side = part.ball({5, 0, -3}, 1, -1);
  Touch askew = top;
  askew.toward = Vector3(1, 1, 0).normalized();
  const auto expect_refused = [&](TouchedShape shape, const std::vector<Touch>& touches) {
    const auto found = find_frame(shape, touches, part.machine);
    ASSERT_FALSE(found);
    EXPECT_FALSE(found.error().empty());
  };
  expect_refused(TouchedShape::kFace, {});
  expect_refused(TouchedShape::kFace, {top, side});
  expect_refused(TouchedShape::kFace, {askew});
  expect_refused(TouchedShape::kEdge, {top, side});
  expect_refused(TouchedShape::kEdge, {side, side});
  expect_refused(TouchedShape::kPlane, {top, top, top});
  expect_refused(TouchedShape::kCorner, {top, side});
  expect_refused(TouchedShape::kCorner, {top, top, side});
  expect_refused(TouchedShape::kBore, {top, side});
  expect_refused(TouchedShape::kBore, {side, side, side});
}

TEST(TouchOff, OfAToolGivesTheLengthThatItHas) {
  Part part;
  part.machine.X_MW.rotation = turned(10, 0, 0);
  part.machine.X_MW.origin_mm = Vector3(4, 5, 6);
  JointVector joints{};
  joints[0] = 12, joints[2] = -150;
  const double height = forward(part.machine, 97.25, joints).tip[2];
  const auto length = find_tool_length(joints, height, part.machine);
  ASSERT_TRUE(length) << length.error();
  EXPECT_NEAR(*length, 97.25, 1e-9);
  EXPECT_FALSE(find_tool_length(joints, height + 100, part.machine));
  part.machine.X_MW.rotation = turned(90, 0, 0);
  EXPECT_FALSE(find_tool_length(joints, height, part.machine));
}

TEST(TouchOff, AnglesMakeTheSameRotation) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> draw(-180, 180);
  for (int n = 0; n < 1000; ++n) {
    const double b = n % 10 == 0 ? 90 : n % 10 == 1 ? -90 : draw(engine) / 2;
    const Eigen::Matrix3d rotation = turned(draw(engine), b, draw(engine));
    const Array3 angles = angles_deg(rotation);
    EXPECT_LT((turned(angles[0], angles[1], angles[2]) - rotation).norm(), 1e-7) << n;
  }
}

}  // namespace
}  // namespace meridian::inspect
