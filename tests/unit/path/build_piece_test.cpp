// SPDX-License-Identifier: Apache-2.0
#include "meridian/path/build_piece.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/pose_at.hpp"

namespace meridian {
namespace {

constexpr double kTip_mm = 1e-12;    // reach 1e2 mm * eps = 2e-14, 50x margin
constexpr double kAxis_rad = 1e-15;  // 5 eps

Vector3 tilted(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

void expect_same(const ToolPose& a, const ToolPose& b) {
  EXPECT_LT((a.tip - b.tip).norm(), kTip_mm);
  EXPECT_LT(angle_between(a.axis, b.axis), kAxis_rad);
}

ClBlock half_circle() {
  ClBlock block;
  block.is_arc = true;
  block.centre_mm = {10, 0, 5};
  block.normal = {0, 0, 1};
  block.sweep_rad = std::numbers::pi;
  block.tip_mm = {20, 0, 7};
  return block;
}

TEST(BuildPiece, LineEndsOnItsBlock) {
  const ToolPose begin{{1, 2, 3}, tilted(0.2, 0.1)}, end{{-7, 5, 2}, tilted(0.5, -1.2)};
  const PathPiece piece = make_line(begin, end);
  expect_same(pose_at(piece, 0.0), begin);
  expect_same(pose_at(piece, piece.length), end);
  const double turn = angle_between(begin.axis, end.axis);
  EXPECT_NEAR(piece.length, std::hypot((end.tip - begin.tip).norm(), 50 * turn), 1e-12);
}

TEST(BuildPiece, PureRotationHasALength) {
  const ToolPose begin{{1, 2, 3}, tilted(0.2, 0)}, end{{1, 2, 3}, tilted(0.3, 0)};
  EXPECT_NEAR(make_line(begin, end).length, 5.0, 1e-12);
}

TEST(BuildPiece, HelixRisesEvenlyAndEndsOnItsBlock) {
  const ToolPose begin{{0, 0, 5}, tilted(0.1, 0)}, end{{20, 0, 7}, tilted(0.1, 1)};
  const PathPiece piece = make_arc(begin, end, half_circle());
  expect_same(pose_at(piece, 0.0), begin);
  expect_same(pose_at(piece, piece.length), end);
  const ToolPose middle = pose_at(piece, piece.length / 2);
  EXPECT_NEAR(middle.tip[1], -10, 1e-12);
  EXPECT_NEAR(middle.tip[2], 6, 1e-12);
  EXPECT_NEAR(tip_length(piece), std::hypot(10 * std::numbers::pi, 2), 1e-12);
}

TEST(BuildPiece, SpreadsWhatARoundedCentreLeavesOpen) {
  ClBlock block = half_circle();
  block.centre_mm = {10.004, 0, 5};
  const ToolPose begin{{0, 0, 5}, tilted(0, 0)}, end{{20, 0, 7}, tilted(0, 0)};
  const PathPiece piece = make_arc(begin, end, block);
  expect_same(pose_at(piece, 0.0), begin);
  expect_same(pose_at(piece, piece.length), end);
  EXPECT_NEAR(pose_at(piece, piece.length / 2).tip[1], -10.004, 1e-12);
}

TEST(BuildPiece, FindsWhereAnArcBegins) {
  EXPECT_LT((find_arc_begin(half_circle()) - Vector3(0, 0, 5)).norm(), kTip_mm);
}

TEST(BuildPiece, CutsMeetAndLieOnTheWhole) {
  const ToolPose begin{{0, 0, 5}, tilted(0.1, 0)}, end{{20, 0, 7}, tilted(0.4, 1)};
  for (const PathPiece& whole : {make_line(begin, end), make_arc(begin, end, half_circle())}) {
    const PathPiece first = cut_piece(whole, 0, 0.3), second = cut_piece(whole, 0.3, 1);
    EXPECT_NEAR(first.length + second.length, whole.length, 1e-12);
    expect_same(pose_at(first, first.length), pose_at(second, 0.0));
    expect_same(pose_at(second, 0.5 * second.length), pose_at(whole, 0.65 * whole.length));
    expect_same(pose_at(second, second.length), end);
  }
}

TEST(BuildPiece, AzimuthPiecesLieOnTheSameGreatCircle) {
  const Vector3 a = Vector3(-0.2, 1e-3, 1).normalized(), b = Vector3(0.25, 1e-3, 1).normalized();
  const PathPiece whole = make_line({{0, 0, 0}, a}, {{8, 0, 0}, b});
  const PolePassage passage = find_passage(whole, Vector3::UnitZ());
  EXPECT_NEAR(passage.offset, 1e-3, 1e-8);
  const PathPiece part = cut_by_azimuth(whole, passage, -1.4, 1.3);
  const Vector3 normal = to_vector(whole.axis_begin).cross(to_vector(whole.axis_normal));
  double before = -1;
  for (int n = 0; n <= 10; ++n) {
    const ToolPose pose = pose_at(part, part.length * n / 10);
    EXPECT_NEAR(pose.axis.dot(normal), 0, 1e-15);
    // The tip stands where it does on the whole when the axis is there.
    const double share = angle_between(a, pose.axis) / whole.axis_turn;
    EXPECT_NEAR(pose.tip[0], 8 * share, 1e-12);
    EXPECT_GT(share, before);
    before = share;
  }
}

TEST(BuildPiece, JointMoveCountsRadiansAsFiftyMillimetres) {
  const PathPiece piece = make_joint_move({0, 0, 0, 0, 0, 0}, {3, 0, 0, 0.08, 0, 0}, 0b11000);
  EXPECT_NEAR(piece.length, 5, 1e-12);
}

}  // namespace
}  // namespace meridian
