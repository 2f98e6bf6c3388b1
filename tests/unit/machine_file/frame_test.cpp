// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "service/machine/file/machine_file.hpp"

namespace meridian::config {
namespace {

constexpr double kTolerance = 1e-15;  // a few eps of unit matrices

TEST(Frame, OfThreeNumbersOnlyMovesTheWorkpiece) {
  const RigidTransform frame = parse_frame("1,-2.5,3e2");
  EXPECT_EQ(frame.origin_mm, Vector3(1, -2.5, 300));
  EXPECT_EQ(frame.rotation, Eigen::Matrix3d::Identity());
}

TEST(Frame, OfSixNumbersTurnsAboutXThenYThenZ) {
  const RigidTransform frame = parse_frame("0,0,0,10,20,30");
  const double d = std::numbers::pi / 180;
  const Eigen::Matrix3d expected =
      (Eigen::AngleAxisd(30 * d, Vector3::UnitZ()) * Eigen::AngleAxisd(20 * d, Vector3::UnitY()) *
       Eigen::AngleAxisd(10 * d, Vector3::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((frame.rotation - expected).norm(), kTolerance);
}

TEST(Frame, IsExactAtQuarterTurns) {
  EXPECT_EQ(parse_frame("0,0,0,0,0,90").rotation * Vector3(1, 0, 0), Vector3(0, 1, 0));
  EXPECT_EQ(parse_frame("0,0,0,180,0,0").rotation * Vector3(0, 1, 0), Vector3(0, -1, 0));
  EXPECT_EQ(parse_frame("0,0,0,0,-90,0").rotation * Vector3(1, 0, 0), Vector3(0, 0, 1));
  EXPECT_EQ(parse_frame("0,0,0,0,0,-270").rotation * Vector3(1, 0, 0), Vector3(0, 1, 0));
}

TEST(Frame, ThatIsNotOneIsRefusedWithAnExample) {
  for (const char* text :
       {"", "1", "1,2", "1,2,3,4", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,x", "1,2,", "1, 2,3",
        "1,2,3 ", "nan,0,0", "inf,0,0", "1e6,0,0", "0,0,0,0,0,361", "1;2;3", ",1,2,3"}) {
    try {
      (void)parse_frame(text);
      ADD_FAILURE() << "accepted \"" << text << "\"";
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.fault().file, "--frame");
      EXPECT_NE(error.fault().value.find(text), std::string::npos);
      EXPECT_NE(error.fault().remedy.find("--frame 0,0,120"), std::string::npos);
    }
  }
}

TEST(Frame, PlacesTheWorkpieceOfAMachine) {
  MachineModel model;
  place_workpiece(model, parse_frame("1,2,3,0,0,180"));
  EXPECT_EQ(model.X_MW.origin_mm, Vector3(1, 2, 3));
  EXPECT_EQ(model.X_MW.rotation * Vector3(1, 0, 0), Vector3(-1, 0, 0));
}

TEST(Frame, OfASetUpRowIsThatOfTheSameNumbersBitForBit) {
  const auto [x, y, z, a, b, c] = parse_frame_values("10.1,-2.3,120.7,3.3,-7.7,33.1");
  const RigidTransform given = parse_frame("10.1,-2.3,120.7,3.3,-7.7,33.1");
  const RigidTransform row =
      frame_of({.number = 1, .origin_mm = {x, y, z}, .rotation_deg = {a, b, c}});
  EXPECT_EQ(row.origin_mm, given.origin_mm);
  EXPECT_EQ(row.rotation, given.rotation);
}

}  // namespace
}  // namespace meridian::config
