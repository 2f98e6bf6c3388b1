// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/span_travel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/winding.hpp"
#include "meridian/path/pose_at.hpp"
#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

namespace meridian::test::span_travel {
namespace {

/// Round the pole, 0.2 off it, by 0.1 rad per span.
Lean round(double u) { return {0.2 * std::cos(0.1 * u), 0.2 * std::sin(0.1 * u)}; }

struct Followed {
  explicit Followed(int b = 0) : branch(b) {
    for (const BandSpan& band : leaning_path(100, round)) {
      JointSpan span;
      span.band = band;
      span.branch = branch;
      spans.push_back(span);
    }
    start = joints_at(0, {});
    model.joints[3].is_endless = false;
    set_travel(-100, 100);
  }
  [[nodiscard]] JointVector joints_at(std::size_t n, const JointVector& near) const {
    return solve(model, 100, pose_on(spans[n].band.c, 0.0), branch, near).q;
  }
  void set_travel(double low, double high) {
    model.joints[3].limits.travel_min = low;
    model.joints[3].limits.travel_max = high;
  }
  /// The number of the span that leaves travel, and where to.
  std::pair<int, double> follow(double by = 0) {
    JointVector begin = start;
    begin[3] += by;
    travel.begin(begin, 100);
    for (std::size_t n = 0; n < spans.size(); ++n) {
      if (const auto outside = travel.follow(spans[n]))
        return {static_cast<int>(n), outside->value};
    }
    return {-1, 0};
  }

  int branch;
  MachineModel model = bench_machine();
  std::vector<JointSpan> spans;
  JointVector start{};
  SpanTravel travel{model};
};

TEST(SpanTravel, FollowsTheJointOverEveryWinding) {
  for (const int branch : {0, 1}) {
    Followed path(branch);
    EXPECT_EQ(path.follow().first, -1);
    const double sense = path.joints_at(1, path.start)[3] > path.start[3] ? 1 : -1;
    const JointVector end = path.travel.end_of(path.spans.back(), 0);
    // spans.back() was followed already: once more from its end is the same place.
    EXPECT_NEAR(end[3], path.start[3] + sense * 10, 0.02);
  }
}

TEST(SpanTravel, SaysWhereTheJointWouldComeToOutsideTravel) {
  Followed path;
  const double sense = path.joints_at(1, path.start)[3] > path.start[3] ? 1 : -1;
  const double begin = path.start[3];
  // After 4.25 rad: in span 42.
  path.set_travel(sense > 0 ? -100 : begin - 4.25, sense > 0 ? begin + 4.25 : 100);
  const auto [span, outside] = path.follow();
  EXPECT_EQ(span, 42);
  EXPECT_NEAR(outside, begin + sense * 4.3, 2e-3) << "where that span ends";
}

TEST(SpanTravel, KeepsAMarginForWhatLiesBetweenItsPoints) {
  Followed path;
  const double sense = path.joints_at(1, path.start)[3] > path.start[3] ? 1 : -1;
  const double begin = path.start[3];
  const JointVector at = path.joints_at(43, path.start);
  const double end = begin + sense * 4.3;
  ASSERT_NEAR(std::remainder(at[3] - end, kTurn_rad), 0, 1e-9);
  const auto travel_to = [&](double value) {
    path.set_travel(sense > 0 ? -100 : value, sense > 0 ? value : 100);
    return path.follow().first;
  };
  EXPECT_EQ(travel_to(end + sense * 5e-5), 42) << "within the margin of 1e-4";
  EXPECT_EQ(travel_to(end + sense * 1e-2), 43) << "the next one";
}

TEST(SpanTravel, LetsAJointAtTheEndOfTravelLeaveIt) {
  Followed path;
  const double sense = path.joints_at(1, path.start)[3] > path.start[3] ? 1 : -1;
  path.set_travel(sense > 0 ? path.start[3] : -100, sense > 0 ? 100 : path.start[3]);
  EXPECT_EQ(path.follow().first, -1);
}

TEST(SpanTravel, SaysWhetherTheNextSpanFitsAnotherWinding) {
  Followed path;
  path.travel.begin(path.start, 100);
  path.set_travel(path.start[3] - 7, path.start[3] + 7);
  EXPECT_TRUE(path.travel.fits(path.spans[0], 0));
  EXPECT_TRUE(path.travel.fits(path.spans[0], kTurn_rad));
  EXPECT_TRUE(path.travel.fits(path.spans[0], -kTurn_rad));
  EXPECT_FALSE(path.travel.fits(path.spans[0], 2 * kTurn_rad));
  EXPECT_FALSE(path.travel.fits(path.spans[0], -2 * kTurn_rad));
  EXPECT_NEAR(
      path.travel.end_of(path.spans[0], kTurn_rad)[3] - path.travel.end_of(path.spans[0], 0)[3],
      kTurn_rad, 1e-9);
  path.model.joints[0].limits.travel_min = 1e6;
  EXPECT_FALSE(path.travel.fits(path.spans[0], 0)) << "every joint counts";
}

TEST(SpanTravel, FollowsAJointThatIsDriven) {
  Followed path;
  for (std::size_t n = 0; n < path.spans.size(); ++n) {
    path.spans[n].is_free_driven = true;
    for (std::size_t k = 0; k < 6; ++k) {
      path.spans[n].free[k] =
          path.start[3] + 0.02 * (static_cast<double>(n) + static_cast<double>(k) / 5);
    }
  }
  EXPECT_EQ(path.follow().first, -1);
  path.set_travel(-100, path.start[3] + 1.01);
  const auto [span, outside] = path.follow();
  EXPECT_EQ(span, 50);
  EXPECT_NEAR(outside, path.start[3] + 1.02, 1e-3);
  path.travel.begin(path.start, 100);
  EXPECT_NEAR(path.travel.end_of(path.spans[0], 1)[3], path.start[3] + 1.02, 1e-12);
}

TEST(SpanTravel, LetsAJointLeaveTheEndOfTravelSlowly) {
  Followed path;
  const double sense = path.joints_at(1, path.start)[3] > path.start[3] ? 1 : -1;
  for (const double sign : {sense, -sense}) {
    for (std::size_t n = 0; n < path.spans.size(); ++n) {  // 2e-5 rad per span
      const auto lean = [sign](double u) {
        return Lean{0.2 * std::cos(2e-5 * u), sign * 0.2 * std::sin(2e-5 * u)};
      };
      const int number = static_cast<int>(n);
      path.spans[n].band = leaning_span(number, lean(number), lean(number + 1));
    }
    // From one winding below zero, and one above.
    for (const double turn : {-kTurn_rad, kTurn_rad}) {
      const double begin = path.start[3] + turn;
      const bool is_upwards = sign == sense;
      path.set_travel(is_upwards ? begin : -100, is_upwards ? 100 : begin);
      EXPECT_EQ(path.follow(turn).first, -1);
      path.set_travel(is_upwards ? -100 : begin, is_upwards ? begin : 100);
      EXPECT_EQ(path.follow(turn).first, 0) << "the other way it leaves at once";
    }
  }
}

TEST(SpanTravel, LooksInsideOfASpanThatSwingsOutAndBack) {
  Followed path;
  JointSpan span;
  span.band = leaning_span(0, {0.2, 0}, {0.2, 0});
  span.band.length = 2;
  span.band.c[4] = {0, 0.12, -0.06};  // y = 0.12 x - 0.06 x²: 0.06 in its middle
  const JointVector begin = solve(path.model, 100, pose_on(span.band.c, 0.0), 0, {}).q;
  const JointVector middle = solve(path.model, 100, pose_on(span.band.c, 1.0), 0, begin).q;
  const double swing = middle[3] - begin[3];
  ASSERT_GT(std::abs(swing), 0.25);
  const auto fits_to = [&](double share) {
    const double end = begin[3] + share * swing;
    path.set_travel(swing > 0 ? -100 : end, swing > 0 ? end : 100);
    path.travel.begin(begin, 100);
    return !path.travel.follow(span);
  };
  EXPECT_FALSE(fits_to(0.9));
  EXPECT_TRUE(fits_to(1.2));
}

TEST(SpanTravel, FollowsADrivenSpanOfAnyLength) {
  Followed path;
  JointSpan span;
  span.band = leaning_span(0, {0.2, 0}, {0.2, 0.002});
  span.band.length = 2.5;
  span.is_free_driven = true;
  for (std::size_t k = 0; k < 6; ++k) span.free[k] = path.start[3] + 0.1 * static_cast<double>(k);
  path.travel.begin(path.start, 100);
  EXPECT_NEAR(path.travel.end_of(span, 0)[3], path.start[3] + 0.5, 1e-12);
}

TEST(SpanTravel, SaysWhetherTheNextSpanFitsFromOtherJoints) {
  Followed path;
  const JointVector other = solve(path.model, 100, pose_on(path.spans[0].band.c, 0.0), 1, {}).q;
  JointSpan span = path.spans[0];
  span.branch = 1;
  EXPECT_TRUE(path.travel.fits_from(other, span));
  EXPECT_NEAR(path.travel.end_from(other, span)[3] - other[3],
              path.travel.end_from(path.start, path.spans[0])[3] - path.start[3], 1e-3);
  path.model.joints[1].limits.travel_max = -1e6;
  EXPECT_FALSE(path.travel.fits_from(other, span)) << "a slide is outside";
  path.model = bench_machine();
  path.model.joints[3].is_endless = false;
  const double end = path.travel.end_from(other, span)[3];
  path.set_travel(end > other[3] ? -100 : 0.5 * (end + other[3]),
                  end > other[3] ? 0.5 * (end + other[3]) : 100);
  EXPECT_FALSE(path.travel.fits_from(other, span)) << "the redundant joint is";
}

/// Out along a meridian from 0.2 to 0.4 rad; the tilt has 0.3 on the side where it begins.
struct LeaningOut {
  LeaningOut() {
    span.band = leaning_span(0, {0.2, 0}, {0.4, 0});
    path.start = solve(path.model, 100, pose_on(span.band.c, 0.0), 0, {}).q;
    is_up = path.start[4] > 0;
    set_tilt(0.3, 1);
    path.travel.begin(path.start, 100);
  }
  void set_tilt(double here, double there) {
    JointLimits& tilt = path.model.joints[4].limits;
    tilt.travel_max = is_up ? here : there;
    tilt.travel_min = is_up ? -there : -here;
  }

  Followed path;
  JointSpan span;
  bool is_up = true;
};

TEST(SpanTravel, SaysWhereTheTiltLeavesItsTravelAndTheOtherBranchKeepsIt) {
  LeaningOut one;
  const auto outside = one.path.travel.follow(one.span);
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->joint, 4);
  EXPECT_GT(std::abs(outside->value), 0.3);
  EXPECT_LT(std::abs(outside->value), 0.4);
}

TEST(SpanTravel, LeavesATiltThatNoBranchKeepsToTheFeed) {
  LeaningOut one;
  one.set_tilt(0.3, 0.3);
  EXPECT_FALSE(one.path.travel.follow(one.span)) << "the feed refuses it by name";
}

TEST(SpanTravel, LeavesADrivenSpanOnItsBranch) {
  LeaningOut one;
  one.span.is_free_driven = true;
  one.span.free.fill(one.path.start[3]);
  EXPECT_FALSE(one.path.travel.follow(one.span));
}

TEST(SpanTravel, LooksAtTheTiltWhereCIsEndless) {
  LeaningOut one;
  one.path.model.joints[3].is_endless = true;
  one.path.set_travel(0, 0);
  const auto outside = one.path.travel.follow(one.span);
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->joint, 4);
}

TEST(SpanTravel, SeesATurnBesideThePole) {
  // Past the pole at 0.001 in one span: half a turn.
  Followed path;
  JointSpan span;
  span.band = leaning_span(0, {0.1, 0.001}, {-0.1, 0.001});
  const JointVector begin = solve(path.model, 100, pose_on(span.band.c, 0.0), 0, {}).q;
  path.travel.begin(begin, 100);
  ASSERT_FALSE(path.travel.follow(span));
  path.travel.begin(begin, 100);
  const double turn = path.travel.end_of(span, 0)[3] - begin[3];
  EXPECT_NEAR(std::abs(turn), std::numbers::pi - 0.02, 1e-3);
}

}  // namespace
}  // namespace meridian::test::span_travel
