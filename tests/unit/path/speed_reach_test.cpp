// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/speed_reach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <vector>

namespace meridian::test::speed_reach {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A straight line of cuts along x, one vertex each, each with the feed that the test gives it.
class Line {
 public:
  Line() { line_->begin({Vector3::Zero(), Vector3::UnitZ()}, {}); }

  Line& cut(double length_mm, double tip_mm_per_s, double turn_rad_per_s = 0) {
    ClBlock block;
    block.tip_mm = {u_.back() + length_mm, 0, 0};
    block.axis = {0, 0, 1};
    line_->take(block);
    EXPECT_EQ(line_->last(), static_cast<std::int64_t>(u_.size()));
    u_.push_back(block.tip_mm[0]);
    (*line_)[line_->last()].asked_mm_per_s = tip_mm_per_s;
    (*line_)[line_->last()].asked_rad_per_s = turn_rad_per_s;
    return *this;
  }

  [[nodiscard]] const BandPolyline& operator*() const { return *line_; }
  [[nodiscard]] double u(std::size_t vertex) const { return u_[vertex]; }
  [[nodiscard]] std::size_t cuts() const { return u_.size() - 1; }

 private:
  std::unique_ptr<BandPolyline> line_ = std::make_unique<BandPolyline>();
  std::vector<double> u_{0};
};

TEST(LargestAhead, IsTheLargestThatWasNotDropped) {
  LargestAhead ahead(8);
  EXPECT_EQ(ahead.largest(), kInfinite) << "nothing is asked for";
  ahead.add(1, 20);
  ahead.add(2, 30);
  ahead.add(3, 10);
  EXPECT_EQ(ahead.largest(), 30);
  ahead.drop_to(1.999);
  EXPECT_EQ(ahead.largest(), 30);
  ahead.drop_to(2);
  EXPECT_EQ(ahead.largest(), 10) << "what ends there is behind";
  ahead.drop_to(3);
  EXPECT_EQ(ahead.largest(), kInfinite);
  ahead.add(4, 5);
  ahead.clear();
  EXPECT_EQ(ahead.largest(), kInfinite);
}

TEST(LargestAhead, LosesTheOldestWhereItIsFull) {
  LargestAhead ahead(4);
  for (int n = 0; n < 6; ++n) ahead.add(n, 100 - n);  // falling: each counts
  EXPECT_EQ(ahead.largest(), 98);
}

TEST(SpeedReach, CountsBlocksWithinReachOfTheWholeStretch) {
  Line line;
  for (int n = 1; n <= 20; ++n) line.cut(1, n == 1 ? 50 : n == 16 ? 80 : 10, n == 16 ? 0.8 : 0.1);
  SpeedReach speeds;
  speeds.begin();
  speeds.go_to(*line, 0, 1, 1);
  EXPECT_EQ(speeds.tip_mm_per_s(), 50);
  EXPECT_EQ(speeds.turn_rad_per_s(), 0.1);
  speeds.go_to(*line, 1, 5.9, 6);
  EXPECT_EQ(speeds.tip_mm_per_s(), 50) << "the first block ends 4.9 mm before the stretch does";
  speeds.go_to(*line, 5.9, 6.1, 7);
  EXPECT_EQ(speeds.tip_mm_per_s(), 10);
  speeds.go_to(*line, 9.9, 10, 10);
  EXPECT_EQ(speeds.tip_mm_per_s(), 10) << "block 16 begins 5.1 mm behind where the stretch begins";
  speeds.go_to(*line, 10.1, 10.2, 11);
  EXPECT_EQ(speeds.tip_mm_per_s(), 80);
  EXPECT_EQ(speeds.turn_rad_per_s(), 0.8);
}

TEST(SpeedReach, LooksNoFartherThanTheVerticesThatAnyWindowWaitsFor) {
  Line line;
  const auto farthest = static_cast<int>(kVertexReach) + 1;  // from the segment that ends at 1
  for (int n = 1; n <= farthest + 10; ++n)
    line.cut(1e-3, n == farthest ? 20 : n > farthest ? 90 : 1);
  SpeedReach speeds;
  speeds.begin();
  speeds.go_to(*line, 0, 1e-3, 1);
  EXPECT_EQ(speeds.tip_mm_per_s(), 20);
}

TEST(SpeedReach, BeginsAnewWithWhatIsThere) {
  Line line, other;
  line.cut(1, 70).cut(1, 60);
  other.cut(1, 20).cut(1, 30);
  SpeedReach speeds;
  speeds.begin();
  speeds.go_to(*line, 0, 1, 1);
  speeds.begin();
  speeds.go_to(*other, 0, 1, 1);
  EXPECT_EQ(speeds.tip_mm_per_s(), 30);
}

/// Against a look at every block, over stretches that follow one another.
TEST(SpeedReach, IsTheLargestOfAllBlocksWithinReachHoweverLongTheyAre) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<double> asked{0};
    Line line;
    for (int n = 0; n < 300; ++n) {
      asked.push_back(1 + std::floor(20 * uniform(engine)));
      line.cut(std::pow(10.0, 2.5 * uniform(engine) - 1.5), asked.back());
    }
    SpeedReach speeds;
    speeds.begin();
    double u0 = 0;
    std::size_t end = 1;
    while (u0 < line.u(line.cuts())) {
      const double u1 = std::min(u0 + 3 * uniform(engine), line.u(line.cuts()));
      while (line.u(end) < u1) ++end;
      speeds.go_to(*line, u0, u1, static_cast<std::int64_t>(end));
      double max = 0;
      for (std::size_t n = 1; n <= line.cuts(); ++n) {
        const bool counts = line.u(n - 1) < u0 + kSpeedReach_mm && line.u(n) > u1 - kSpeedReach_mm;
        if (counts) max = std::max(max, asked[n]);
      }
      ASSERT_EQ(speeds.tip_mm_per_s(), max) << "from " << u0 << " to " << u1;
      u0 = u1;
    }
  }
}

}  // namespace
}  // namespace meridian::test::speed_reach
