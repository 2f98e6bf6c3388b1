// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/block_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "support/programs.hpp"

namespace meridian::stream {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr ActionPeer kPeer{.is_there = true};

class Check : public testing::Test {
 protected:
  BlockReject checked(ClBlock block, const ActionPeer& actions = kPeer) {
    last_ = block;
    return check_.check(last_, actions);
  }
  RejectCode code(const ClBlock& block, const ActionPeer& actions = kPeer) {
    return checked(block, actions).code;
  }

  MachineModel model_ = test::lai_machine();
  BlockCheck check_{model_, {{1, 80.0}, {7, 120.0}}};
  ClBlock last_;
};

TEST_F(Check, PassesAGoodCutUntouched) {
  const ClBlock block = test::good_cut(0);
  EXPECT_EQ(code(block), RejectCode::kNone);
  EXPECT_EQ(last_.tip_mm, block.tip_mm);
  EXPECT_EQ(last_.axis, block.axis);
  EXPECT_EQ(last_.feed, block.feed);
}

TEST_F(Check, RefusesEveryNumberThatIsNotFinite) {
  double ClBlock::*const scalars[] = {&ClBlock::feed, &ClBlock::value, &ClBlock::sweep_rad};
  Array3 ClBlock::*const vectors[] = {&ClBlock::tip_mm, &ClBlock::axis, &ClBlock::centre_mm,
                                      &ClBlock::normal};
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    for (const auto scalar : scalars) {
      ClBlock block = test::good_cut(0);
      block.*scalar = bad;
      EXPECT_EQ(code(block), RejectCode::kNotFinite);
    }
    for (const auto vector : vectors) {
      for (std::size_t i = 0; i < 3; ++i) {
        ClBlock block = test::good_cut(0);
        (block.*vector)[i] = bad;
        EXPECT_EQ(code(block), RejectCode::kNotFinite);
      }
    }
  }
}

TEST_F(Check, SaysWhichNumberIsNotFinite) {
  ClBlock block = test::good_cut(4);
  block.axis[1] = kNaN;
  EXPECT_EQ(describe(checked(block), model_), "line 14, block 4: axis j is not a finite number");
}

TEST_F(Check, NormalisesAnAxisNearUnitLengthAndRefusesOthers) {
  for (const double norm : {1 - 0.9e-3, 1 + 0.9e-3}) {
    ClBlock block = test::good_cut(0);
    for (double& component : block.axis) component *= norm;
    EXPECT_EQ(code(block), RejectCode::kNone) << norm;
    EXPECT_NEAR(to_vector(last_.axis).norm(), 1, 4e-16);
  }
  for (const double norm : {0.0, 0.5, 1 - 1.1e-3, 1 + 1.1e-3, 2.0}) {
    ClBlock block = test::good_cut(0);
    for (double& component : block.axis) component *= norm;
    const BlockReject verdict = checked(block);
    EXPECT_EQ(verdict.code, RejectCode::kAxisNotUnit) << norm;
    EXPECT_NEAR(verdict.value, norm, 1e-15);
  }
}

TEST_F(Check, CheckingTwiceGivesTheSameBits) {
  for (int i = 0; i < 1000; ++i) {
    ClBlock block = test::good_cut(0);
    const double tilt = 1e-3 * i, azimuth = 0.7 * i;
    block.axis = {std::sin(tilt) * std::cos(azimuth) * 1.0003,
                  std::sin(tilt) * std::sin(azimuth) * 1.0003, std::cos(tilt) * 1.0003};
    ASSERT_EQ(code(block), RejectCode::kNone);
    const Array3 once = last_.axis;
    ASSERT_EQ(code(last_), RejectCode::kNone);
    ASSERT_EQ(last_.axis, once) << i;
  }
}

TEST_F(Check, RefusesAbsurdFeeds) {
  for (const double feed_mm_per_min : {0.0, -1.0, 1.0001e6, 1e300}) {
    ClBlock block = test::good_cut(0);
    block.feed = feed_mm_per_min / 60;
    EXPECT_EQ(code(block), RejectCode::kFeed) << feed_mm_per_min;
  }
  ClBlock without_meaning = test::good_cut(0);
  without_meaning.feed_meaning = FeedMeaning::kNone;
  EXPECT_EQ(code(without_meaning), RejectCode::kFeed);
}

TEST_F(Check, LimitsAFeedAboveTheMachinesAndReportsIt) {
  ClBlock block = test::good_cut(0);
  block.feed = model_.max_feed_mm_per_s * 2;
  EXPECT_EQ(code(block), RejectCode::kNone);
  EXPECT_EQ(last_.feed, model_.max_feed_mm_per_s);
  EXPECT_EQ(check_.feeds_limited(), 1u);
  EXPECT_EQ(check_.first_limited_line(), block.line);
}

TEST_F(Check, LimitsAnInverseTimeFeedByTheSpeedItAsksFor) {
  ASSERT_EQ(code(test::good_cut(0)), RejectCode::kNone);
  ClBlock block = test::good_cut(50);  // 50 mm on
  block.feed_meaning = FeedMeaning::kInverseTime;
  block.feed = 4 * model_.max_feed_mm_per_s / 50;
  EXPECT_EQ(code(block), RejectCode::kNone);
  EXPECT_DOUBLE_EQ(last_.feed, model_.max_feed_mm_per_s / 50);
}

TEST_F(Check, RapidNeedsNoFeed) {
  ClBlock block = test::good_cut(0);
  block.kind = BlockKind::kRapid;
  block.feed_meaning = FeedMeaning::kNone;
  block.feed = 0;
  EXPECT_EQ(code(block), RejectCode::kNone);
}

TEST_F(Check, NamesTheJointThatLeavesTravel) {
  ClBlock block = test::good_cut(3);
  block.tip_mm = {0, 0, 5000};
  const BlockReject verdict = checked(block);
  EXPECT_EQ(verdict.code, RejectCode::kTravel);
  EXPECT_EQ(verdict.joint, 2);
  const std::string text = describe(verdict, model_);
  EXPECT_NE(text.find("line 13, block 3: b4 at -"), std::string::npos) << text;
  EXPECT_NE(text.find("(travel -600 to 600 mm)"), std::string::npos) << text;
}

TEST_F(Check, TakesALineThatIsBeyondTravelByRoundingToTheEndOfTravelAndCountsIt) {
  JointVector q{};
  for (int i = 0; i < model_.joint_count; ++i) q[i] = model_.joints[i].home;
  q[4] = .2;  // off the pole, where the redundant joint would find room elsewhere
  const double max = model_.joints[2].limits.travel_max;
  ClBlock block = test::good_cut(0);
  const auto ends_at = [&](double at) {
    q[2] = at;
    const ToolPose pose = forward(model_, model_.tool_length_mm, q);
    block.tip_mm = to_array(pose.tip);
    block.axis = to_array(pose.axis);
  };
  ends_at(max + 9e-4);
  EXPECT_EQ(code(block), RejectCode::kNone);
  EXPECT_EQ(check_.poses_rounded(), 1U);
  EXPECT_EQ(check_.first_rounded_line(), block.line);
  EXPECT_LE((to_vector(last_.tip_mm) - to_vector(block.tip_mm)).norm(), 1e-3);
  const ClBlock once = last_;
  EXPECT_EQ(code(once), RejectCode::kNone);  // of itself no more
  EXPECT_EQ(last_.tip_mm, once.tip_mm);
  EXPECT_EQ(check_.poses_rounded(), 1U);
  ends_at(max + 1.2e-3);
  EXPECT_EQ(code(block), RejectCode::kTravel);
}

TEST_F(Check, RefusesATiltBeyondTheHead) {
  ClBlock block = test::good_cut(0);
  block.axis = {std::sin(1.2), 0, std::cos(1.2)};
  const BlockReject verdict = checked(block);
  EXPECT_EQ(verdict.code, RejectCode::kTravel);
  EXPECT_EQ(verdict.joint, 4);
  EXPECT_NE(describe(verdict, model_).find("(travel -60 to 60 deg)"), std::string::npos);
}

TEST_F(Check, OnThePoleAnyPlaceOfTheRedundantJointWillDo) {
  // x = 700 mm is outside b3 with the table at 0 and inside when the table stands at an angle.
  ClBlock block = test::good_cut(0);
  block.axis = {0, 0, 1};
  block.tip_mm = {700, 0, 0};
  EXPECT_EQ(code(block), RejectCode::kNone);
  block.tip_mm = {1200, 0, 0};
  EXPECT_EQ(code(block), RejectCode::kTravel);
}

TEST_F(Check, ActionsNeedSomebodyWhoAnswersThem) {
  for (const BlockKind kind : {BlockKind::kAuxiliary, BlockKind::kTool, BlockKind::kStop}) {
    ClBlock block = test::good_cut(0);
    block.kind = kind;
    block.value = 7;
    EXPECT_EQ(code(block, {}), RejectCode::kNoActionPeer);
    EXPECT_EQ(code(block, {.is_ignored = true}), RejectCode::kNone);
    EXPECT_EQ(code(block, {.is_there = true}), RejectCode::kNone);
  }
}

TEST_F(Check, RefusesAToolThatIsNotInTheTable) {
  ClBlock block = test::good_cut(0);
  block.kind = BlockKind::kTool;
  for (const double number : {2.0, 6.5, 1e12}) {
    block.value = number;
    EXPECT_EQ(code(block), RejectCode::kUnknownTool) << number;
  }
}

TEST_F(Check, AToolBlockChangesTheLengthThatLaterBlocksAreCheckedWith) {
  ClBlock tool = test::good_cut(0);
  tool.kind = BlockKind::kTool;
  tool.value = 7;
  EXPECT_EQ(code(tool), RejectCode::kNone);
  EXPECT_EQ(check_.tool_length_mm(), 120);
}

TEST_F(Check, RefusesAnArcThatMissesItsEnd) {
  ASSERT_EQ(code(test::good_cut(0)), RejectCode::kNone);  // ends in (0, 0, 0)
  ClBlock arc = test::good_cut(1);
  arc.is_arc = true;
  arc.centre_mm = {10, 0, 0};
  arc.normal = {0, 0, 1};
  arc.sweep_rad = std::numbers::pi;
  arc.tip_mm = {20.1, 0, 0};
  const BlockReject verdict = checked(arc);
  EXPECT_EQ(verdict.code, RejectCode::kArc);
  EXPECT_NEAR(verdict.value, 0.1, 1e-9);
  arc.tip_mm = {20.01, 0, 3};  // a helix, rounded to 0.01 mm
  EXPECT_EQ(code(arc), RejectCode::kNone);
}

TEST_F(Check, RefusesAnArcWithoutABegin) {
  ClBlock arc = test::good_cut(0);
  arc.is_arc = true;
  arc.sweep_rad = 1;
  EXPECT_EQ(code(arc), RejectCode::kArc);
}

TEST_F(Check, RefusesKindsItDoesNotKnow) {
  ClBlock block = test::good_cut(0);
  block.kind = static_cast<BlockKind>(200);
  EXPECT_EQ(code(block), RejectCode::kKind);
  block = test::good_cut(0);
  block.feed_meaning = static_cast<FeedMeaning>(3);
  EXPECT_EQ(code(block), RejectCode::kKind);
}

TEST_F(Check, RefusesADwellThatNeverEnds) {
  ClBlock block = test::good_cut(0);
  block.kind = BlockKind::kDwell;
  for (const double seconds : {-1.0, 1e9}) {
    block.value = seconds;
    EXPECT_EQ(code(block), RejectCode::kValue);
  }
  block.value = 2;
  EXPECT_EQ(code(block), RejectCode::kNone);
}

}  // namespace
}  // namespace meridian::stream
