// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/checked_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meridian/geometry/great_circle.hpp"
#include "support/sample_recording.hpp"

namespace meridian::record {
namespace {

using test::cut_to;

TEST(CheckedPath, BeginsAtTheFirstMotionBlock) {
  CheckedPath path(100, 0);
  ClBlock dwell;
  dwell.kind = BlockKind::kDwell;
  path.add(dwell, 0);
  EXPECT_FALSE(path.has_begin());
  path.add(cut_to(1, {1, 2, 3}, 0, 10), 0);
  EXPECT_TRUE(path.has_begin());
  EXPECT_EQ(path.begin().tip, Vector3(1, 2, 3));
  EXPECT_TRUE(path.elements().empty());
  path.add(cut_to(2, {1, 2, 7}, 0, 10), 0);
  ASSERT_EQ(path.elements().size(), 1U);
  EXPECT_DOUBLE_EQ(path.length(), 4);
  EXPECT_DOUBLE_EQ(path.elements()[0].feed_mm_per_s, 10);
}

TEST(CheckedPath, KeepsArcsAndHelicesExact) {
  CheckedPath path(100, 0);
  path.add(cut_to(1, {10, 0, 0}, 0, 10), 0);
  ClBlock arc = cut_to(2, {10, 0, 6}, 0.4, 10);
  arc.is_arc = true;
  arc.centre_mm = {0, 0, 0};
  arc.normal = {0, 0, 1};
  arc.sweep_rad = 2 * std::numbers::pi;
  path.add(arc, 0);
  ASSERT_GE(path.elements().size(), 24U);
  const ToolPose begin{{10, 0, 0}, {0, 0, 1}};
  const ToolPose end{{10, 0, 6}, {std::sin(0.4), 0, std::cos(0.4)}};
  for (std::size_t i = 0; i < path.elements().size(); ++i) {
    const PathElement& element = path.elements()[i];
    const ToolPose before = i == 0 ? begin : path.elements()[i - 1].pose(1);
    EXPECT_LT((element.pose(0).tip - before.tip).norm(), 1e-12);
    EXPECT_LT(angle_between(element.pose(0).axis, before.axis), 1e-12);
    const ToolPose middle = element.pose(0.5);
    EXPECT_NEAR(std::hypot(middle.tip[0], middle.tip[1]), 10, 1e-12);
    const ToolPose slope = element.slope(0.5);
    const Vector3 tip = (element.pose(0.5 + 1e-6).tip - element.pose(0.5 - 1e-6).tip) / 2e-6;
    const Vector3 axis = (element.pose(0.5 + 1e-6).axis - element.pose(0.5 - 1e-6).axis) / 2e-6;
    EXPECT_LT((slope.tip - tip).norm(), 1e-8);
    EXPECT_LT((slope.axis - axis).norm(), 1e-8);
    EXPECT_EQ(element.is_block_end, i + 1 == path.elements().size());
  }
  const ToolPose last = path.elements().back().pose(1);
  EXPECT_LT((last.tip - end.tip).norm(), 1e-12);
  EXPECT_LT(angle_between(last.axis, end.axis), 1e-12);
}

TEST(CheckedPath, LimitsTipAndAxisWhereFeedIsInverseTime) {
  CheckedPath path(100, 50);
  path.add(cut_to(1, {0, 0, 0}, 0, 10), 0);
  ClBlock block = cut_to(2, {3, 0, 4}, 0.2, 0);
  block.feed_meaning = FeedMeaning::kInverseTime;
  block.feed = 4;
  path.add(block, 0);
  EXPECT_NEAR(path.elements()[0].feed_mm_per_s, 20, 1e-12);
  EXPECT_NEAR(path.elements()[0].turn_rad_per_s, 0.8, 1e-12);
  EXPECT_NEAR(path.elements()[0].path_mm_per_s, 4 * std::hypot(5, 50 * 0.2), 1e-9);
  path.add(cut_to(3, {30, 0, 4}, 0.2, 1000), 0);
  EXPECT_EQ(path.elements()[1].feed_mm_per_s, 50) << "the machine's highest feed holds";
  EXPECT_EQ(path.elements()[1].turn_rad_per_s, 0);
  EXPECT_NEAR(path.elements()[1].path_begin, std::hypot(5, 10), 1e-9);
}

TEST(CheckedPath, MovesTheTipWithANewTool) {
  CheckedPath path(100, 0);
  path.add(cut_to(1, {0, 0, 0}, 0, 10), 0);
  ClBlock tool;
  tool.kind = BlockKind::kTool;
  path.add(tool, 130);
  path.add(cut_to(3, {0, 0, 0}, 0, 10), 0);
  ASSERT_EQ(path.elements().size(), 1U);
  EXPECT_EQ(path.elements()[0].pose(0).tip, Vector3(0, 0, -30));
  EXPECT_EQ(path.elements()[0].tool_length_mm, 130);
}

}  // namespace
}  // namespace meridian::record
