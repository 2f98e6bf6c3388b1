// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/rest_to_rest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

Vector3 tilted(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

ClBlock block_of(BlockKind kind, std::uint64_t sequence) {
  ClBlock block;
  block.kind = kind;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence) + 100;
  return block;
}

ClBlock cut(std::uint64_t sequence, const Vector3& tip, const Vector3& axis, double feed = 50) {
  ClBlock block = block_of(BlockKind::kCut, sequence);
  block.tip_mm = to_array(tip);
  block.axis = to_array(axis);
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = feed;
  return block;
}

/// A planner at its port, and all that it published.
struct Bench {
  explicit Bench(const MachineModel& m = test::lai_machine(), const ToolTable& tools = {})
      : model(m), planner(model, tools) {
    planner.begin(start, model.tool_length_mm, 0);
  }
  PlanResult plan(const ClBlock& block) { return planner.plan(block, writer); }
  PlanResult plan_and_take(const ClBlock& block) {
    const PlanResult result = plan(block);
    take();
    return result;
  }
  void take() {
    while (const TimePiece* piece = reader.advance()) {
      times.push_back(*piece);
      paths.push_back(reader.path() != nullptr ? *reader.path() : PathPiece{});
    }
  }
  void forget() {
    take();
    times.clear();
    paths.clear();
  }
  [[nodiscard]] double duration() const {
    double sum = 0;
    for (const TimePiece& piece : times) sum += piece.duration;
    return sum;
  }

  MachineModel model;
  JointVector start{10, 20, -30, 0.5, 0.1, 0};
  std::unique_ptr<MotionPort> port = std::make_unique<MotionPort>();
  MotionWriter writer{*port};
  MotionReader reader{*port};
  RestToRestPlanner planner;
  std::vector<TimePiece> times;
  std::vector<PathPiece> paths;
};

TEST(RestToRest, ApproachesTheFirstBlockUpAcrossAndDown) {
  Bench bench;
  const ToolPose from = forward(bench.model, bench.model.tool_length_mm, bench.start);
  ASSERT_EQ(bench.plan_and_take(cut(0, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  ASSERT_EQ(bench.paths.back().index, 2U);
  const PathPiece& up = bench.paths.front();
  EXPECT_EQ(up.kind, PathKind::kLine);
  EXPECT_NEAR(to_vector(up.tip_delta).dot(from.axis), bench.model.clearance_mm, 1e-9);
  const PathPiece& down = bench.paths.back();
  EXPECT_NEAR(down.length, bench.model.clearance_mm, 1e-9);
  for (const PathPiece& path : bench.paths) EXPECT_EQ(path.motion, MotionKind::kApproach);
  EXPECT_EQ(bench.times.back().feed_mm_per_s, bench.model.approach_feed_mm_per_s);
  const ToolPose at = forward(bench.model, bench.model.tool_length_mm, bench.planner.joints());
  EXPECT_LT((at.tip - Vector3(50, 0, 20)).norm(), 1e-9);
  EXPECT_LT(angle_between(at.axis, tilted(0.3, 1)), 1e-12);
}

TEST(RestToRest, DeclaresTheApproachOnceWhenItIsPublished) {
  Bench bench;
  Approach way;
  EXPECT_FALSE(bench.planner.take_approach(way));
  ASSERT_EQ(bench.plan(block_of(BlockKind::kDwell, 0)).status, PlanStatus::kOk);
  EXPECT_FALSE(bench.planner.take_approach(way));
  bench.forget();
  ASSERT_EQ(bench.plan_and_take(cut(1, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  ASSERT_TRUE(bench.planner.take_approach(way));
  EXPECT_TRUE(way.is_planned);
  EXPECT_EQ(way.sequence, 1U);
  EXPECT_EQ(way.line, 101U);
  EXPECT_EQ(way.from, bench.start);
  const PathPiece& last = bench.paths.back();
  EXPECT_EQ(way.branch, last.branch);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(way.to[i], last.joints_end[i], 1e-9) << i;
  EXPECT_EQ(way.retract, bench.model.clearance_mm);
  EXPECT_EQ(way.descent, bench.model.clearance_mm);
  double length = 0;
  for (std::size_t i = 0; i < bench.paths.size(); ++i) {
    const bool is_new = i == 0 || bench.paths[i].index != bench.paths[i - 1].index;
    if (is_new) length += bench.paths[i].length;
  }
  EXPECT_NEAR(way.length, length, 1e-9);
  EXPECT_NEAR(way.time, bench.duration(), 1e-9);
  EXPECT_FALSE(bench.planner.take_approach(way));
  ASSERT_EQ(bench.plan(cut(2, {60, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  EXPECT_FALSE(bench.planner.take_approach(way)) << "one for a program";
}

TEST(RestToRest, RetractsOnlyAsFarAsTravelAllows) {
  MachineModel model = test::lai_machine();
  model.joints[2].limits.travel_min = -40;  // b4 rises towards minus
  Bench bench(model);
  ASSERT_EQ(bench.plan_and_take(cut(0, {50, 0, 180}, tilted(0, 0))).status, PlanStatus::kOk);
  for (const PathPiece& path : bench.paths) {
    EXPECT_GE(std::min(path.joints_begin[2], path.joints_end[2]), -40 - 1e-9);
  }
  EXPECT_NEAR(bench.paths.front().joints_end[2], -40, 1e-9);
}

TEST(RestToRest, HasNothingToApproachWhereItStandsAlready) {
  Bench bench;
  const ToolPose here = forward(bench.model, bench.model.tool_length_mm, bench.start);
  ASSERT_EQ(bench.plan_and_take(cut(0, here.tip, here.axis)).status, PlanStatus::kOk);
  EXPECT_LT(bench.duration(), 1e-3);
}

TEST(RestToRest, PassesBlocksOfNoLength) {
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  bench.forget();
  for (std::uint64_t n = 1; n < 4; ++n) {
    ASSERT_EQ(bench.plan_and_take(cut(n, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  }
  EXPECT_TRUE(bench.times.empty());
}

TEST(RestToRest, MakesOneWindowFromRestOfEveryBlock) {
  Bench bench;
  for (std::uint64_t n = 0; n < 5; ++n) {
    ASSERT_EQ(bench.plan_and_take(cut(n, {10.0 * static_cast<double>(n), 0, 20}, tilted(0.3, 0.2)))
                  .status,
              PlanStatus::kOk);
  }
  std::uint32_t window = 0;
  for (std::size_t n = 0; n < bench.times.size(); ++n) {
    const TimePiece& piece = bench.times[n];
    EXPECT_TRUE(piece.is_from_rest);
    EXPECT_FALSE(piece.is_tail);
    if (n > 0 && piece.sequence != bench.times[n - 1].sequence) ++window;
    EXPECT_EQ(piece.window, window);
  }
  EXPECT_EQ(window, 4U);
}

TEST(RestToRest, BarriersRestInTheirOrder) {
  Bench bench(test::lai_machine(), ToolTable({{7, 95, 5}}));
  ClBlock dwell = block_of(BlockKind::kDwell, 0);
  dwell.value = 1.5;
  ClBlock tool = block_of(BlockKind::kTool, 2);
  tool.value = 7;
  std::vector<TimeKind> kinds;
  for (const ClBlock& block :
       {dwell, block_of(BlockKind::kAuxiliary, 1), tool, block_of(BlockKind::kStop, 3),
        block_of(BlockKind::kOptionalStop, 4), block_of(BlockKind::kEnd, 5)}) {
    ASSERT_EQ(bench.plan_and_take(block).status, PlanStatus::kOk);
    kinds.push_back(bench.times.back().kind);
    EXPECT_EQ(bench.times.back().sequence, block.sequence);
    EXPECT_EQ(bench.times.back().line, block.line);
  }
  EXPECT_EQ(kinds,
            (std::vector<TimeKind>{TimeKind::kDwell, TimeKind::kAction, TimeKind::kAction,
                                   TimeKind::kStop, TimeKind::kOptionalStop, TimeKind::kEnd}));
  EXPECT_EQ(bench.times.front().duration, 1.5);
}

TEST(RestToRest, StartsBehindAToolChangeFromTheSameJoints) {
  Bench bench(test::lai_machine(), ToolTable({{7, 95, 5}}));
  ASSERT_EQ(bench.plan(cut(0, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  const JointVector before = bench.planner.joints();
  ClBlock tool = block_of(BlockKind::kTool, 1);
  tool.value = 7;
  ASSERT_EQ(bench.plan(tool).status, PlanStatus::kOk);
  EXPECT_EQ(bench.planner.joints(), before);
  EXPECT_EQ(bench.planner.tool_length_mm(), 95);
  bench.forget();
  ASSERT_EQ(bench.plan_and_take(cut(2, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  EXPECT_EQ(bench.paths.front().tool_length_mm, 95);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(bench.paths.front().joints_begin[i], before[i], 1e-9);
  EXPECT_NEAR(bench.paths.front().length, 110 - 95, 1e-9);
}

/// Tool and spindle of a program that begins in its middle, ahead of its first motion.
TEST(RestToRest, LeavesThePartBeforeTheFirstActionOfAProgramThatMayBeginInIt) {
  Bench bench(test::lai_machine(), ToolTable({{7, 95, 5}}));
  bench.planner.begin(bench.start, bench.model.tool_length_mm, 1, true);
  bench.reader.set_epoch(1);
  const ToolPose from = forward(bench.model, bench.model.tool_length_mm, bench.start);
  ClBlock tool = block_of(BlockKind::kTool, 0);
  tool.value = 7;
  ASSERT_EQ(bench.plan_and_take(tool).status, PlanStatus::kOk);
  ASSERT_FALSE(bench.times.empty());
  EXPECT_EQ(bench.times.front().kind, TimeKind::kMove);
  EXPECT_EQ(bench.times.back().kind, TimeKind::kAction);
  EXPECT_LT(bench.times.front().window, bench.times.back().window);
  const PathPiece up = bench.paths.front();
  EXPECT_EQ(up.motion, MotionKind::kApproach);
  EXPECT_NEAR(to_vector(up.tip_delta).dot(from.axis), bench.model.clearance_mm, 1e-9);
  const JointVector over = bench.planner.joints();
  const double lift_time = bench.duration();

  bench.forget();
  ASSERT_EQ(bench.plan_and_take(block_of(BlockKind::kAuxiliary, 1)).status, PlanStatus::kOk);
  EXPECT_EQ(bench.times.size(), 1U) << "once is enough";
  ASSERT_EQ(bench.plan_and_take(cut(2, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  const auto first = std::find_if(bench.paths.begin(), bench.paths.end(),
                                  [](const PathPiece& path) { return path.length > 0; });
  ASSERT_NE(first, bench.paths.end());
  EXPECT_EQ(first->kind, PathKind::kJoint) << "it is off the part already";
  EXPECT_EQ(first->joints_begin, over);

  Approach way;
  ASSERT_TRUE(bench.planner.take_approach(way));
  EXPECT_EQ(way.from, bench.start);
  EXPECT_TRUE(way.has_rest);
  EXPECT_EQ(way.retract, bench.model.clearance_mm);
  EXPECT_EQ(way.descent, bench.model.clearance_mm);
  EXPECT_NEAR(way.time, lift_time + bench.duration(), 1e-9);
}

/// A tool that is longer than the one that broke in the cut, changed where the retraction ended.
struct LongerTool {
  explicit LongerTool(const MachineModel& machine)
      : bench(machine, ToolTable({{8, kLonger_mm, 5}})) {
    bench.planner.begin(bench.start, bench.model.tool_length_mm, 1, true);
    bench.reader.set_epoch(1);
    ClBlock tool = block_of(BlockKind::kTool, 0);
    tool.value = 8;
    EXPECT_EQ(bench.plan_and_take(tool).status, PlanStatus::kOk);
    over = bench.planner.joints();
    bench.forget();
  }
  /// How far the tip is above where the old one stood.
  [[nodiscard]] double above(const JointVector& joints) const {
    const ToolPose from = forward(bench.model, bench.model.tool_length_mm, bench.start);
    return (forward(bench.model, kLonger_mm, joints).tip - from.tip).dot(from.axis);
  }

  static constexpr double kLonger_mm = 110 + 70;
  Bench bench;
  JointVector over;
};

TEST(RestToRest, LiftsALongerToolOffThePartBeforeJointsMove) {
  ASSERT_EQ(test::lai_machine().tool_length_mm, 110);
  LongerTool longer(test::lai_machine());
  Bench& bench = longer.bench;
  EXPECT_NEAR(longer.above(longer.over), bench.model.clearance_mm - 70, 1e-9) << "in the part";
  ASSERT_EQ(bench.plan_and_take(cut(1, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  const auto move = std::find_if(bench.paths.begin(), bench.paths.end(), [](const PathPiece& path) {
    return path.kind == PathKind::kJoint;
  });
  ASSERT_NE(move, bench.paths.end());
  EXPECT_NEAR(longer.above(move->joints_begin), bench.model.clearance_mm, 1e-6);
  Approach way;
  ASSERT_TRUE(bench.planner.take_approach(way));
  EXPECT_NEAR(way.lift, 70, 1e-9);
}

TEST(RestToRest, RefusesAProgramWhoseLongerToolCannotLeaveThePart) {
  const LongerTool free(test::lai_machine());
  const auto at =
      solve(free.bench.model, LongerTool::kLonger_mm,
            ToolPose{forward(free.bench.model, LongerTool::kLonger_mm, free.over).tip +
                         60 * forward(free.bench.model, LongerTool::kLonger_mm, free.over).axis,
                     forward(free.bench.model, LongerTool::kLonger_mm, free.over).axis},
            0, free.over);
  MachineModel narrow = test::lai_machine();
  int joint = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(at.q[i] - free.over[i]) > std::abs(at.q[joint] - free.over[joint])) joint = i;
  }
  JointLimits& limits = narrow.joints[joint].limits;
  (at.q[joint] > free.over[joint] ? limits.travel_max : limits.travel_min) = at.q[joint];
  LongerTool longer(narrow);
  const PlanResult result = longer.bench.plan_and_take(cut(1, {50, 0, 20}, tilted(0.3, 1)));
  EXPECT_EQ(result.status, PlanStatus::kRefused);
  EXPECT_EQ(result.reject.code, RejectCode::kApproach);
  EXPECT_EQ(result.reject.joint, joint);
  EXPECT_TRUE(longer.bench.times.empty());
}

TEST(RestToRest, DoesTheFirstActionsOfAnyOtherProgramWhereTheMachineStands) {
  Bench bench;
  ASSERT_EQ(bench.plan_and_take(block_of(BlockKind::kAuxiliary, 0)).status, PlanStatus::kOk);
  EXPECT_EQ(bench.times.size(), 1U);
  EXPECT_EQ(bench.times.front().kind, TimeKind::kAction);
}

TEST(RestToRest, RefusesAnUnknownTool) {
  Bench bench;
  ClBlock tool = block_of(BlockKind::kTool, 1);
  tool.value = 12;
  const PlanResult result = bench.plan_and_take(tool);
  EXPECT_EQ(result.status, PlanStatus::kRefused);
  EXPECT_EQ(result.reject.code, RejectCode::kUnknownTool);
  EXPECT_EQ(result.reject.value, 12);
  EXPECT_TRUE(bench.times.empty());
}

TEST(RestToRest, RefusesAWayThatLeavesTravelBetweenTwoLegalBlocks) {
  // The tip far out on the turning table swings b3 past its end between two blocks inside it.
  MachineModel narrow = test::lai_machine();
  const Vector3 tip(200, 0, 20);
  Bench wide(narrow);
  ASSERT_EQ(wide.plan(cut(0, tip, tilted(0.45, -0.6))).status, PlanStatus::kOk);
  const JointVector before = wide.planner.joints();
  ASSERT_EQ(wide.plan(cut(1, tip, tilted(0.45, 0.6))).status, PlanStatus::kOk);
  // The same way, with the end of travel put between the largest value at the ends and the one on
  // the way: refused, and nothing of it published.
  const double at_ends = std::max(before[0], wide.planner.joints()[0]);
  double on_the_way = at_ends;
  for (double s = 0; s <= 1; s += 0.01) {
    const GreatCircle circle = find_great_circle(tilted(0.45, -0.6), tilted(0.45, 0.6));
    const Vector3 axis = axis_on_circle(circle.begin, circle.normal, s * circle.turn);
    const auto at = solve(narrow, narrow.tool_length_mm, ToolPose{tip, axis}, 0, before);
    on_the_way = std::max(on_the_way, at.q[0]);
  }
  ASSERT_GT(on_the_way, at_ends + 1);
  narrow.joints[0].limits.travel_max = 0.5 * (on_the_way + at_ends);
  Bench tight(narrow);
  ASSERT_EQ(tight.plan(cut(0, tip, tilted(0.45, -0.6))).status, PlanStatus::kOk);
  tight.forget();
  const PlanResult refused = tight.plan_and_take(cut(1, tip, tilted(0.45, 0.6)));
  EXPECT_EQ(refused.status, PlanStatus::kRefused);
  EXPECT_EQ(refused.reject.code, RejectCode::kTravelBetween);
  EXPECT_EQ(refused.reject.sequence, 1U);
  EXPECT_EQ(refused.reject.line, 101U);
  EXPECT_EQ(refused.reject.joint, 0);
  EXPECT_GT(refused.reject.value, narrow.joints[0].limits.travel_max);
  EXPECT_TRUE(tight.times.empty());
  // Nor does a later block move, though it could be reached.
  EXPECT_EQ(tight.plan_and_take(cut(2, tip, tilted(0.45, -0.6))).status, PlanStatus::kRefused);
  EXPECT_TRUE(tight.times.empty());
}

TEST(RestToRest, RefusesWhereTheTurnedTableRunsOutOfTravel) {
  Bench bench;  // C two turns each way
  PlanResult result;
  std::uint64_t n = 0;
  for (; n < 200 && result.status == PlanStatus::kOk; ++n) {
    result = bench.plan_and_take(cut(n, {20, 0, 20}, tilted(0.3, 0.5 * static_cast<double>(n))));
  }
  EXPECT_EQ(result.status, PlanStatus::kRefused);
  EXPECT_EQ(result.reject.joint, 3);
  EXPECT_GT(std::abs(result.reject.value), 4 * 3.14159);
  EXPECT_GT(n, 20U);
}

TEST(RestToRest, RefusesWhatIsNoBlock) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    ClBlock block;
    RejectCode code;
  };
  ClBlock no_feed = cut(1, {1, 0, 0}, tilted(0.3, 0), 0);
  ClBlock bad_tip = cut(1, {nan, 0, 0}, tilted(0.3, 0));
  ClBlock bad_axis = cut(1, {1, 0, 0}, {0, 0, 0});
  ClBlock reversed = cut(1, {1, 0, 0}, -tilted(0.3, 0));
  ClBlock bad_feed = cut(1, {1, 0, 0}, tilted(0.3, 0), nan);
  for (const Case& c :
       {Case{no_feed, RejectCode::kFeed}, Case{bad_tip, RejectCode::kNotFinite},
        Case{bad_axis, RejectCode::kNotFinite}, Case{reversed, RejectCode::kAxisReversal},
        Case{bad_feed, RejectCode::kNotFinite}}) {
    Bench bench;
    ASSERT_EQ(bench.plan(cut(0, {0, 0, 0}, tilted(0.3, 0))).status, PlanStatus::kOk);
    bench.forget();
    const PlanResult result = bench.plan_and_take(c.block);
    EXPECT_EQ(result.status, PlanStatus::kRefused);
    EXPECT_EQ(result.reject.code, c.code);
    EXPECT_TRUE(bench.times.empty());
  }
}

TEST(RestToRest, PublishesNothingWithoutRoomAndTheSameLater) {
  Bench bench;
  Bench free;
  std::uint64_t n = 0;
  const auto next = [&n] { return cut(n, {n % 2 == 0 ? 0.0 : 5.0, 0, 20}, tilted(0.3, 0.2)); };
  while (bench.plan(next()).status == PlanStatus::kOk) {
    ASSERT_EQ(free.plan_and_take(next()).status, PlanStatus::kOk);
    ++n;
  }
  EXPECT_EQ(bench.plan(next()).status, PlanStatus::kNoRoom);
  const JointVector before = bench.planner.joints();
  EXPECT_EQ(bench.plan(next()).status, PlanStatus::kNoRoom);
  EXPECT_EQ(bench.planner.joints(), before);
  bench.take();
  ASSERT_EQ(bench.plan_and_take(next()).status, PlanStatus::kOk);
  ASSERT_EQ(free.plan_and_take(next()).status, PlanStatus::kOk);
  ASSERT_EQ(bench.times.size(), free.times.size());
  for (std::size_t k = 0; k < free.times.size(); ++k) {
    ASSERT_EQ(bench.times[k].s0, free.times[k].s0);
    ASSERT_EQ(bench.times[k].duration, free.times[k].duration);
    ASSERT_EQ(bench.times[k].path_index, free.times[k].path_index);
  }
}

TEST(RestToRest, KeepsInverseTimeAndTipFeed) {
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {0, 0, 20}, tilted(0.3, 0))).status, PlanStatus::kOk);
  bench.forget();
  ClBlock inverse = cut(1, {10, 0, 20}, tilted(0.35, 0.2));
  inverse.feed_meaning = FeedMeaning::kInverseTime;
  inverse.feed = 0.5;  // in two seconds
  ASSERT_EQ(bench.plan_and_take(inverse).status, PlanStatus::kOk);
  EXPECT_GT(bench.duration(), 2.0);
  EXPECT_LT(bench.duration(), 2.2);
  for (const TimePiece& time : bench.times) {
    EXPECT_NEAR(time.feed_mm_per_s, 5, 1e-9) << "10 mm in two seconds";
  }
  bench.forget();
  ASSERT_EQ(bench.plan_and_take(cut(2, {60, 0, 20}, tilted(0.35, 0.2), 20)).status,
            PlanStatus::kOk);
  EXPECT_GT(bench.duration(), 2.5);
  EXPECT_LT(bench.duration(), 2.55);
}

TEST(RestToRest, WastesLittleOfTheFastestMotionFromRestToRest) {
  // 100 mm along x by the joints alone: 300 mm/s, 3000 mm/s², 60000 mm/s³ give 0.4833 s; the
  // reserve of the rate filter takes a tenth of the acceleration and a fifth of the jerk.
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {0, 0, 20}, tilted(0, 0))).status, PlanStatus::kOk);
  bench.forget();
  ClBlock rapid = cut(1, to_vector({100, 0, 20}), tilted(0, 0));
  const ToolPose here = forward(bench.model, bench.model.tool_length_mm, bench.planner.joints());
  rapid.tip_mm = to_array(here.tip + Vector3(100 * std::cos(bench.planner.joints()[3]),
                                             100 * std::sin(bench.planner.joints()[3]), 0));
  rapid.kind = BlockKind::kRapid;
  ASSERT_EQ(bench.plan_and_take(rapid).status, PlanStatus::kOk);
  EXPECT_GT(bench.duration(), 0.4833);
  EXPECT_LT(bench.duration(), 0.4833 * 1.06);
}

TEST(RestToRest, EasesTheAxisOnlyOntoThePoleAndSaysSo) {
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {0, 0, 20}, tilted(0.3, 0))).status, PlanStatus::kOk);
  const PlanResult eased = bench.plan(cut(1, {10, 0, 20}, tilted(5e-6, 2)));
  EXPECT_NEAR(eased.axis_deviation_rad, 5e-6, 1e-12);
  EXPECT_NEAR(bench.planner.joints()[4], 0, 1e-15);
  const PlanResult exact = bench.plan(cut(2, {20, 0, 20}, tilted(1e-5, 2)));
  EXPECT_EQ(exact.axis_deviation_rad, 0);
  EXPECT_NEAR(std::abs(bench.planner.joints()[4]), 1e-5, 1e-15);
}

TEST(RestToRest, GivesTheSameBitsForTheSameBlocks) {
  Bench a, b;
  for (std::uint64_t n = 0; n < 30; ++n) {
    const double x = static_cast<double>(n);
    const ClBlock block = cut(n, {7 * std::sin(x), 3 * x, 20}, tilted(0.02 * x, x));
    const auto ra = a.plan_and_take(block), rb = b.plan_and_take(block);
    ASSERT_EQ(ra.status, rb.status);
    if (ra.status != PlanStatus::kOk) break;
  }
  ASSERT_EQ(a.times.size(), b.times.size());
  ASSERT_GT(a.times.size(), 100U);
  for (std::size_t n = 0; n < a.times.size(); ++n) {
    EXPECT_EQ(a.times[n].s0, b.times[n].s0);
    EXPECT_EQ(a.times[n].v, b.times[n].v);
    EXPECT_EQ(a.times[n].j, b.times[n].j);
    EXPECT_EQ(a.times[n].duration, b.times[n].duration);
    EXPECT_EQ(a.times[n].stop_jerk, b.times[n].stop_jerk);
    EXPECT_EQ(a.paths[n].joints_end, b.paths[n].joints_end);
  }
}

}  // namespace
}  // namespace meridian
