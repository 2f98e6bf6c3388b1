// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "property/planner/plan_trace.hpp"
#include "property/planner/random_programs.hpp"
#include "support/machines.hpp"

/// At, through and beside the pole: every limit, tip and axis, and how far C turns.
namespace meridian::test::pole {
namespace {

constexpr double kLimit = 1 + 1e-6;

ClBlock cut(std::uint64_t sequence, const Vector3& tip, const Vector3& axis) {
  ClBlock block;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence) + 1;
  block.tip_mm = to_array(tip);
  block.axis = to_array(axis);
  block.feed = 50;
  block.feed_meaning = FeedMeaning::kTip;
  return block;
}

/// Way of the redundant joint, up and down added.
double free_travel(const Trace& trace) {
  double sum = 0;
  std::uint64_t last = ~std::uint64_t{0};
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    if (trace.times[n].kind != TimeKind::kMove || trace.times[n].path_index == last) continue;
    last = trace.times[n].path_index;
    if (trace.paths[n].motion == MotionKind::kApproach) continue;
    sum += std::abs(trace.paths[n].joints_end[3] - trace.paths[n].joints_begin[3]);
  }
  return sum;
}

void expect_clean(const MachineModel& model, const Trace& trace, const std::vector<ClBlock>& blocks,
                  const JointVector& start) {
  ASSERT_EQ(trace.last.status, PlanStatus::kOk)
      << static_cast<int>(trace.last.reject.code) << " " << trace.last.reject.value;
  const auto programmed = programmed_paths(blocks);
  for (const double cycle : {1e-3, 250e-6}) {
    const auto setpoints = sample(model, trace, cycle, 0.37, start);
    const LimitUse use = measure_limits(model, setpoints, cycle);
    EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where << " cycle " << cycle;
    EXPECT_LE(measure_feed(model, trace, setpoints, cycle), kLimit);
    const Deviation off = measure_deviation(model, trace, setpoints, programmed, 97);
    EXPECT_LE(off.tip_mm, 1e-3);
    EXPECT_LE(units::deg_from_rad(off.axis_rad), 1e-3);
  }
}

TEST(Pole, TurnsNoFartherThanTheAzimuthAsksBetweenWayInAndWayOut) {
  const MachineModel model = lai_machine();
  const JointVector start{0, 0, 0, 0.3, 0.2, 0};
  for (const double between : {0.0, 30.0, 60.0, 90.0, 120.0, 180.0}) {
    for (const double nearly : {0.0, 1e-12, 1e-9, 1e-6, 1e-4}) {
      SCOPED_TRACE(testing::Message() << between << " deg, " << nearly << " deg off the pole");
      const double out = 0.4 + units::rad_from_deg(between);
      const std::vector<ClBlock> blocks = {
          cut(0, {0, 0, 50}, RandomPrograms::axis_of(model, 0.35, 0.4)),
          cut(1, {30, 5, 50}, RandomPrograms::axis_of(model, units::rad_from_deg(nearly), 2.0)),
          cut(2, {60, 20, 45}, RandomPrograms::axis_of(model, 0.3, out))};
      const Trace trace = plan_program(model, blocks, start);
      expect_clean(model, trace, blocks, start);
      // Through the pole the tilt changes its sign instead of a half turn of C.
      EXPECT_NEAR(units::deg_from_rad(free_travel(trace)), std::min(between, 180 - between), 1e-3);
    }
  }
}

TEST(Pole, IsPassedStraightWithoutAStopOrATurn) {
  const MachineModel model = lai_machine();
  const JointVector start{0, 0, 0, 0, 0.2, 0};
  for (const double azimuth : {0.0, 0.7, 1.5707963267948966, 3.0}) {
    const std::vector<ClBlock> blocks = {
        cut(0, {-30, 0, 50}, RandomPrograms::axis_of(model, 0.3, azimuth)),
        cut(1, {30, 10, 50}, RandomPrograms::axis_of(model, -0.3, azimuth))};
    const Trace trace = plan_program(model, blocks, start);
    expect_clean(model, trace, blocks, start);
    EXPECT_NEAR(free_travel(trace), 0, 1e-12);
    std::uint64_t pieces = 0;
    for (const PathPiece& path : trace.paths) {
      if (path.sequence == 1 && path.motion == MotionKind::kCut) pieces = path.index;
    }
    EXPECT_EQ(trace.paths.back().index, pieces);
    EXPECT_NEAR(trace.paths.back().joints_end[4], -trace.paths.back().joints_begin[4], 1e-12);
  }
}

TEST(Pole, IsPassedAtAnyDistance) {
  std::vector<double> times;
  for (const bool is_turned : {false, true}) {
    MachineModel model = lai_machine();
    RandomPrograms draw(99);
    if (is_turned) model.X_MW.rotation = draw.rotation(0.4);
    for (double exponent = -12; exponent <= 0.01; exponent += 0.5) {
      const double distance = units::rad_from_deg(std::pow(10.0, exponent));
      SCOPED_TRACE(testing::Message() << "1e" << exponent << " deg, frame " << is_turned);
      const auto beside = [&](double along) {
        const Vector3 in_machine = Vector3(std::sin(along), distance, std::cos(along)).normalized();
        return Vector3(model.X_MW.rotation.transpose() * in_machine);
      };
      const std::vector<ClBlock> blocks = {cut(0, {-30, 0, 50}, beside(-0.3)),
                                           cut(1, {30, 10, 50}, beside(0.25))};
      const JointVector start{0, 0, 0, 0.1, 0.2, 0};
      const Trace trace = plan_program(model, blocks, start);
      expect_clean(model, trace, blocks, start);
      if (!is_turned) {
        double time = 0;
        for (const TimePiece& piece : trace.times) time += piece.sequence == 1 ? piece.duration : 0;
        times.push_back(time);
      }
    }
  }
  std::printf("seconds for 60 mm past the pole at 1e-12 deg, by half decades, to 1 deg:");
  for (const double time : times) std::printf(" %.2f", time);
  std::printf("\n");
}

TEST(Pole, FlipsTheBranchAtRestWhereTravelAsksForIt) {
  // C may turn little more than a half turn: in at azimuth 0, out at 150 deg on either branch.
  MachineModel model = lai_machine();
  model.joints[3].limits.travel_min = units::rad_from_deg(-100);
  model.joints[3].limits.travel_max = units::rad_from_deg(100);
  const JointVector start{0, 0, 0, 0, 0.2, 0};
  for (const double out : {30.0, 80.0, 150.0, 210.0, 270.0, 359.0}) {
    SCOPED_TRACE(out);
    const std::vector<ClBlock> blocks = {
        cut(0, {0, 0, 50}, RandomPrograms::axis_of(model, 0.3, 0)),
        cut(1, {10, 0, 50}, RandomPrograms::axis_of(model, 0, 0)),
        cut(2, {20, 0, 50}, RandomPrograms::axis_of(model, 0.3, units::rad_from_deg(out)))};
    const Trace trace = plan_program(model, blocks, start);
    expect_clean(model, trace, blocks, start);
    EXPECT_LE(std::abs(trace.joints[3]), units::rad_from_deg(100));
  }
}

TEST(Pole, TurnsAtRestWhereTheTiltMayNotChangeItsSign) {
  MachineModel model = lai_machine();
  model.joints[4].limits.travel_min = 0;
  const JointVector start{0, 0, 0, 0, 0.2, 0};
  const std::vector<ClBlock> blocks = {
      cut(0, {-30, 0, 50}, RandomPrograms::axis_of(model, 0.3, 0.5)),
      cut(1, {30, 10, 50}, RandomPrograms::axis_of(model, -0.3, 0.5))};
  const Trace trace = plan_program(model, blocks, start);
  expect_clean(model, trace, blocks, start);
  EXPECT_NEAR(free_travel(trace), std::numbers::pi, 1e-9);
  bool has_turned = false;
  for (const PathPiece& path : trace.paths) has_turned |= path.motion == MotionKind::kPoleTurn;
  EXPECT_TRUE(has_turned);
}

}  // namespace
}  // namespace meridian::test::pole
