// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "read_text.hpp"
#include "service/programs/cl/cl_points.hpp"
#include "service/programs/cl/interpreter/run_cl.hpp"
#include "support/scratch.hpp"

namespace meridian::cl {
namespace {

std::vector<ClPoint> points_of(const std::vector<ClBlock>& blocks) {
  PointWalker walker;
  std::vector<ClPoint> points;
  for (const ClBlock& block : blocks) {
    walker.walk(block, [&points](const ClPoint& p) { points.push_back(p); });
  }
  return points;
}

TEST(Points, OfAnArcLieOnItWithinATenthOfAMicrometre) {
  const auto read = read_body("GOTO/50,0,0,0,0,1\nCIRCLE/0,0,0,0,0,1,50\nGOTO/0,50,9,.6,0,.8\n");
  const auto points = points_of(read.blocks);
  ASSERT_GT(points.size(), 100U);
  double farthest = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector3& p = points[i].tip;
    EXPECT_NEAR(std::hypot(p[0], p[1]), 50, 1e-12);
    const double angle = std::atan2(p[1], p[0]);
    EXPECT_NEAR(p[2], 9 * angle / std::asin(1.0), 1e-12);
    EXPECT_NEAR(points[i].axis.norm(), 1, 1e-15);
    EXPECT_NEAR(std::atan2(points[i].axis[0], points[i].axis[2]),
                std::atan2(.6, .8) * angle / std::asin(1.0), 1e-12);
    const Vector3 middle = (p + points[i + 1].tip) / 2;
    farthest = std::max(farthest, 50 - std::hypot(middle[0], middle[1]));
  }
  EXPECT_LE(farthest, 1e-4);
  EXPECT_GT(farthest, 0.5e-4);  // and no finer than asked for
  EXPECT_EQ(points.back().tip, (Vector3{0, 50, 9}));
}

TEST(Points, CarryTheFeedOfTheBlockThatEndsThere) {
  const auto points = points_of(
      read_body("RAPID\nGOTO/0,0,0\nGOTO/0,0,1\nFEDRAT/INVERS,30\nGOTO/0,0,7\nDELAY/1\n").blocks);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].feed_mm_per_s, 0);
  EXPECT_EQ(points[1].feed_mm_per_s, 10);
  EXPECT_DOUBLE_EQ(points[2].feed_mm_per_s, 3);  // 6 mm in two seconds
}

TEST(Points, OfOneBlockComeFromItsBegin) {
  const auto read = read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10,0,0\n");
  std::size_t count = 0;
  Vector3 last = Vector3::Zero();
  for_each_point({{10, 0, 0}, {0, 0, 1}}, read.blocks.at(1), 1e-3, [&](const ClPoint& p) {
    ++count;
    last = p.tip;
  });
  EXPECT_EQ(count, 223U);  // 2 pi / (2 acos(1 - 1e-4)) = 222.1
  EXPECT_EQ(last, (Vector3{10, 0, 0}));
}

TEST(RunCl, WritesSevenColumnsThatReadBackBitForBit) {
  const test::Scratch part(".apt");
  std::ofstream(part.path())
      << "UNITS/INCHES\nFEDRAT/10\nRAPID\nGOTO/.1,.2,.3\nGOTO/1,2,-0.0,0,.6,.8\nFINI\n";
  RunOptions options;
  options.file = part.path();
  std::ostringstream out;
  std::ostringstream err;
  ASSERT_EQ(run_cl(options, out, err), 0) << err.str();
  std::istringstream in(out.str());
  std::vector<double> numbers;
  for (double x = 0; in >> x;) numbers.push_back(x);
  ASSERT_EQ(numbers.size(), 14U);
  EXPECT_EQ(numbers[0], .1 * 25.4);
  EXPECT_EQ(numbers[6], 0);
  EXPECT_EQ(numbers[13], 10 * 25.4 / 60 * 60);
}

TEST(RunCl, RefusesWithTheMessageAndLeavesNoFile) {
  const test::Scratch part(".apt");
  const test::Scratch written(".cl");
  std::ofstream(part.path()) << "UNITS/MM\nFEDRAT/10\nGOTO/0,0,0\nWOBBLE/1\nFINI\n";
  RunOptions options;
  options.file = part.path();
  options.output = written.path();
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(run_cl(options, out, err), 3);
  EXPECT_NE(err.str().find(":4: unknown word 'WOBBLE'; --allow-unknown WOBBLE"), std::string::npos)
      << err.str();
  EXPECT_FALSE(std::ifstream(options.output).good());
  options.file = part.path() + ".not";
  EXPECT_EQ(run_cl(options, out, err), 3);
}

}  // namespace
}  // namespace meridian::cl
