// SPDX-License-Identifier: Apache-2.0

/// check() on blocks in inverse time: speeds of tip and axis, and the time that a block takes.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "check_fixture.hpp"

namespace meridian::record {
namespace {

using test::cut_to;
using test::SampleRun;

/// A turn of the axis between moves of the tip, recorded at up to 27 mm/s and 0.365 rad/s.
class CheckInverseTime : public test::Check {
 protected:
  CheckInverseTime() {
    lift_joint_limits();
    blocks = {cut_to(1, {60, -40, 20}, 0.3, 30), cut_to(2, {60, -28, 20}, 0.3, 30),
              cut_to(3, {75, -28, 20}, 0.3, 30), cut_to(4, {75, -28, 20}, 0.6, 30),
              cut_to(5, {75, -40, 20}, 0.6, 30)};
    record_in_time();
    ask({28, 28, 0.37, 28});
  }

  void record_in_time() {
    records = SampleRun(model, blocks).records;
    for (ClBlock& block : blocks) block.feed_meaning = FeedMeaning::kInverseTime;
  }
  /// Tip speeds of the blocks, of the third that of the axis.
  void ask(const std::array<double, 4>& speeds) {
    const std::array<double, 4> lengths = {12, 15, 0.3, 12};
    for (std::size_t i = 0; i < 4; ++i) blocks[i + 1].feed = speeds[i] / lengths[i];
  }
};

TEST_F(CheckInverseTime, PassesWhatIsAsFastAsBlocksAsk) {
  const CheckReport report = run();
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_NEAR(report.feed.value, 27.0 / 28.0, 0.01);
}

TEST_F(CheckInverseTime, RefusesATipFasterThanEveryBlockWithinReach) {
  ask({28, 20, 0.37, 28});
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kFeed);
  EXPECT_EQ(report.findings[0].line, 3U);
  EXPECT_NEAR(report.feed.value, 27.0 / 20.0, 0.01) << "farther than 5 mm from the faster ones";
  EXPECT_GT(report.findings[0].cycle, records[middle_of(3)].setpoint.cycle - 100);
  EXPECT_LT(report.findings[0].cycle, records[middle_of(3)].setpoint.cycle + 100);
}

TEST_F(CheckInverseTime, RefusesAnAxisFasterThanEveryBlockWithinReach) {
  ask({28, 28, 0.33, 28});
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kTurnRate);
  EXPECT_EQ(report.findings[0].line, 4U) << "the tip rests there";
  options.feed_factor = 1.2;
  EXPECT_TRUE(run().passed()) << "an override allows it";
}

TEST_F(CheckInverseTime, RefusesATipAboveTheMachinesHighestFeed) {
  model.max_feed_mm_per_s = 26;
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kFeed);
  EXPECT_NEAR(report.feed.value, 27.0 / 26.0, 0.01);
}

TEST_F(CheckInverseTime, RefusesABlockThatTakesLessThanItsTimeBetweenFasterOnes) {
  blocks = {cut_to(1, {60, -40, 20}, 0.3, 30), cut_to(2, {60, -28, 20}, 0.3, 30),
            cut_to(3, {64, -28, 20}, 0.3, 30), cut_to(4, {64, -40, 20}, 0.3, 30)};
  record_in_time();
  blocks[1].feed = blocks[3].feed = 28.0 / 12;
  blocks[2].feed = 1 / 0.27;  // it took 0.324 s, some of it within tolerances of its ends
  EXPECT_TRUE(run().passed()) << to_text(run());
  blocks[2].feed = 1 / 0.34;
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kBlockTime);
  EXPECT_EQ(report.findings[0].line, 3U);
  options.feed_factor = 1.25;
  EXPECT_TRUE(run().passed()) << "an override allows it";
}

TEST_F(CheckInverseTime, RefusesATipThatMovesWhereOnlyTheAxisShould) {
  blocks = {cut_to(1, {75, -28, 20}, 0.3, 30), cut_to(2, {75, -28, 20}, 0.6, 30),
            cut_to(3, {75, -28, 20}, 0.3, 30), cut_to(4, {75, -28, 20}, 0.6, 30)};
  record_in_time();
  for (ClBlock& block : blocks) block.feed = 0.37 / 0.3;
  options.tip_tolerance_mm = 0.01;
  EXPECT_TRUE(run().passed()) << to_text(run());
  const std::size_t middle = middle_of(3);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(middle)) / 60.0;
    if (std::abs(x) < 1) {  // b4 moves the tip alone
      records[i].joints[2] += 0.008 * std::pow(1 - x * x, 4);
      records[i].setpoint.velocity[2] += 0.008 * 4 * std::pow(1 - x * x, 3) * -2 * x / 0.060;
    }
  }
  expect_only(run(), Finding::Kind::kFeed);
}

}  // namespace
}  // namespace meridian::record
