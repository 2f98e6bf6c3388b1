// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "service/analysis/simulate/feed_picture.hpp"
#include "support/machines.hpp"
#include "support/scratch.hpp"
#include "support/simulated_run.hpp"
#include "support/text_file.hpp"

namespace meridian::simulate {
namespace {

struct Explained {
  test::SimulatedRun run;
  std::vector<ExplainedBlock> blocks;
  std::vector<ExplainedCycle> cycles;  ///< causes that lay ahead filled in
  Explanation whole;

  [[nodiscard]] const ExplainedBlock& at_line(std::uint32_t line) const {
    return *std::find_if(blocks.begin(), blocks.end(),
                         [line](const ExplainedBlock& block) { return block.line == line; });
  }
};

[[nodiscard]] Explained explain(const std::string& text, const MachineModel& model,
                                SimulateOptions options = {}) {
  Explained out;
  Explainer explainer(
      model, [&out](const ExplainedBlock& block) { out.blocks.push_back(block); },
      [&out](const ExplainedCycle& cycle) { out.cycles.push_back(cycle); },
      [&out](Cause cause) {
        for (ExplainedCycle& cycle : out.cycles) {
          if (!cycle.cause) cycle.cause = cause;
        }
      });
  options.explainer = &explainer;
  out.run = test::run_simulation(text, model, options);
  out.whole = explainer.explanation();
  return out;
}

[[nodiscard]] MachineModel machine(Transition transition) {
  MachineModel model = test::bench_machine();
  model.transition = transition;
  return model;
}

constexpr const char* kHead = "UNITS/MM\nMULTAX/ON\nFEDRAT/3000,MMPM\n";

/// 60 mm, a corner, 60 mm, a dwell, and 2000 blocks of 0.01 mm: several in each cycle.
[[nodiscard]] std::string corner_and_dense() {
  std::string text = kHead;
  text +=
      "GOTO/0,0,0,0.2,0,0.979795897\nGOTO/60,0,0,0.2,0,0.979795897\n"
      "GOTO/60,60,0,0.2,0,0.979795897\nDELAY/0.25\n";
  char line[80];
  for (int n = 1; n <= 2000; ++n) {
    std::snprintf(line, sizeof line, "GOTO/%.4f,60,0,0.2,0,0.979795897\n", 60 - 0.01 * n);
    text += line;
  }
  return text + "FINI\n";
}

class Explain : public testing::TestWithParam<Transition> {};

TEST_P(Explain, ChargesEveryCycleToABlockOnceAndReportsEveryBlockInOrder) {
  const Explained out = explain(corner_and_dense(), machine(GetParam()));
  ASSERT_EQ(out.run.report.outcome, Outcome::kDone);
  ASSERT_EQ(out.blocks.size(), out.run.report.blocks);
  double time = 0, lost = 0, distance = 0;
  for (std::size_t n = 0; n < out.blocks.size(); ++n) {
    const ExplainedBlock& block = out.blocks[n];
    EXPECT_EQ(block.sequence, n);
    time += block.time_s;
    lost += block.lost_s;
    distance += block.distance_mm;
    const float limits = std::accumulate(block.by_limit.begin(), block.by_limit.end(), 0.0F);
    const float causes = std::accumulate(block.by_cause.begin(), block.by_cause.end(), 0.0F);
    EXPECT_NEAR(limits, block.time_s, 1e-4 * block.time_s + 1e-7);
    EXPECT_NEAR(causes, block.time_s, 1e-4 * block.time_s + 1e-7);
  }
  // To the cycle: what the report counts between the approach and the end.
  EXPECT_NEAR(time, out.run.report.program_s, 1e-6);
  EXPECT_EQ(out.whole.cycles, out.cycles.size());
  EXPECT_NEAR(out.whole.time_s, out.run.report.program_s, 1e-6);
  EXPECT_NEAR(lost, out.whole.lost_s, 1e-9);
  EXPECT_NEAR(distance, 140, 0.1);
  // Every cycle has its cause in the end, and all together those of the whole.
  std::array<double, kCauses> by_cause{};
  for (const ExplainedCycle& cycle : out.cycles) {
    ASSERT_TRUE(cycle.cause);
    by_cause[static_cast<std::size_t>(*cycle.cause)] += cycle.time_s;
  }
  for (std::size_t cause = 0; cause < kCauses; ++cause) {
    double time_s = 0;
    for (const auto& of_limit : out.whole.shares) time_s += of_limit[cause].time_s;
    EXPECT_NEAR(by_cause[cause], time_s, 1e-6) << name_of(static_cast<Cause>(cause));
  }
}

INSTANTIATE_TEST_SUITE_P(Transitions, Explain,
                         testing::Values(Transition::kExactStop, Transition::kSmooth),
                         [](const auto& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

TEST(ExplainSmooth, ChargesACornerWithTheWayDownToItAndUpAgain) {
  const Explained out = explain(corner_and_dense(), machine(Transition::kSmooth));
  for (const std::uint32_t line : {5U, 6U}) {
    const ExplainedBlock& block = out.at_line(line);
    EXPECT_GT(block.by_cause[static_cast<std::size_t>(Cause::kFeed)], 0.9F);
    EXPECT_GT(block.by_cause[static_cast<std::size_t>(Cause::kBend)], 0.02F);
    EXPECT_GT(block.by_cause[static_cast<std::size_t>(Cause::kRest)], 0.02F);
    EXPECT_LT(block.by_cause[static_cast<std::size_t>(Cause::kPath)], 0.02F);
    EXPECT_LT(block.min_mm_per_s, 0.5 * block.mean_mm_per_s());
    EXPECT_NEAR(block.time_s - block.lost_s, 60.0 / 50, 0.01);
  }
  const ExplainedBlock& dwell = out.at_line(7);
  EXPECT_NEAR(dwell.time_s, 0.25, 0.002);
  EXPECT_EQ(dwell.main_cause(), Cause::kWaiting);
  // In the middle of the dense blocks the feed alone holds.
  const ExplainedBlock& dense = out.at_line(1000);
  EXPECT_EQ(dense.main_cause(), Cause::kFeed);
  EXPECT_EQ(dense.main_limit(), kFeedLimit);
  EXPECT_NEAR(dense.mean_mm_per_s(), 50, 0.2);
  EXPECT_NEAR(dense.time_s, 0.01 / 50, 2e-6);
}

TEST(ExplainSmooth, NamesTheJointThatTurnsBesideThePole) {
  const std::string text = std::string(kHead) +
                           "GOTO/-30,0,0,-0.2,0.0175,0.97964\nGOTO/30,0,0,0.2,0.0175,0.97964\n"
                           "FINI\n";
  const Explained out = explain(text, machine(Transition::kSmooth));
  const ExplainedBlock& block = out.at_line(5);
  EXPECT_EQ(name_of(block.main_limit(), test::bench_machine()), "theta1 velocity");
  EXPECT_EQ(block.main_cause(), Cause::kPole);
  ASSERT_FALSE(out.whole.worst.empty());
  EXPECT_EQ(out.whole.worst.front().first_line, 5U);
}

/// Five blocks whose axis passes the pole at 0.05 deg, in the third.
constexpr const char* kPastThePole =
    "UNITS/MM\nMULTAX/ON\nFEDRAT/3000,MMPM\n"
    "GOTO/-30,0,0,-0.2,0.000872665,0.979795508\nGOTO/-15,0,0,-0.1,0.000872665,0.994987055\n"
    "GOTO/-5,0,0,-0.03,0.000872665,0.999549519\nGOTO/5,0,0,0.03,0.000872665,0.999549519\n"
    "GOTO/15,0,0,0.1,0.000872665,0.994987055\nGOTO/30,0,0,0.2,0.000872665,0.979795508\nFINI\n";

TEST(ExplainSmooth, ReportsTheBlocksWhoseAxisWasEasedBesideThePoleAndWhy) {
  MachineModel model = machine(Transition::kSmooth);
  const Explained out = explain(kPastThePole, model);
  const SimulateReport& report = out.run.report;
  ASSERT_EQ(report.relaxed_count, 1U);
  const RelaxedAxis& relaxed_axis = report.relaxed_axes[0];
  EXPECT_LE(relaxed_axis.first_line, 7U);
  EXPECT_GE(relaxed_axis.last_line, 7U);
  // The pass takes 0.05 deg; the stretch reaches 20 mm to either side, and what smoothing takes at
  // the corners there is in it, of the blocks from line 5 on.
  EXPECT_NEAR(units::deg_from_rad(relaxed_axis.deviation_rad), 0.063, 0.003);
  EXPECT_LE(relaxed_axis.deviation_rad, model.tolerances.axis_rad);
  EXPECT_EQ(relaxed_axis.first_line, 5U);
  EXPECT_EQ(relaxed_axis.reason, RelaxedReason::kThrough);
  EXPECT_EQ(out.at_line(7).relaxed_rad, relaxed_axis.deviation_rad);
  EXPECT_NE(to_text(report, model).find("deg, through the pole"), std::string::npos)
      << to_text(report, model);

  model.pole_policy = PolePolicy::kExact;
  const Explained exact = explain(kPastThePole, model);
  EXPECT_EQ(exact.run.report.relaxed_count, 0U);
  EXPECT_GT(exact.run.report.program_s, report.program_s + 1);
}

TEST(ExplainExactStop, NamesRests) {
  std::string text = kHead;
  for (int n = 0; n < 6; ++n) {
    text += "GOTO/" + std::to_string(2 * n) + ",0,0,0.2,0,0.979795897\n";
  }
  const Explained out = explain(text + "FINI\n", machine(Transition::kExactStop));
  for (std::uint32_t line = 5; line < 10; ++line) {
    const ExplainedBlock& block = out.at_line(line);
    EXPECT_EQ(block.main_cause(), Cause::kRest) << line;
    EXPECT_GE(order_of(block.main_limit()), 1) << line;
  }
}

TEST(ExplainSmooth, DistinguishesTheMachinesFeedFromTheProgramsAndFromJoints) {
  MachineModel model = machine(Transition::kSmooth);
  model.max_feed_mm_per_s = 20;
  const Explained out = explain(corner_and_dense(), model);
  const ExplainedBlock& block = out.at_line(5);
  EXPECT_EQ(block.main_limit(), kMachineFeedLimit);
  EXPECT_NEAR(block.programmed_mm_per_s, 50, 1e-9);
  EXPECT_NEAR(block.lost_s, 60.0 / 20 - 60.0 / 50, 0.1);
}

TEST(ExplainSmooth, ReportsTheOperatorsOverrideAndHold) {
  SimulateOptions options;
  const std::string text = corner_and_dense();
  const Explained free = explain(text, machine(Transition::kSmooth));
  const auto start = static_cast<std::int64_t>(free.run.report.approach_s * 1e3);
  options.events.verbs = {{start + 300, Verb::kFeedOverride, 0.5},
                          {start + 1200, Verb::kHold, 0},
                          {start + 2200, Verb::kResume, 0},
                          {start + 2300, Verb::kFeedOverride, 1}};
  const Explained out = explain(text, machine(Transition::kSmooth), options);
  const ExplainedBlock& block = out.at_line(5);
  EXPECT_GT(block.by_cause[static_cast<std::size_t>(Cause::kOverride)], 1.0F);
  EXPECT_GT(block.time_s, free.at_line(5).time_s + 1.2);
}

TEST(ExplainSmooth, UsesTheFeedOfInverseTimeBlocks) {
  const std::string text =
      "UNITS/MM\nMULTAX/ON\nFEDRAT/3000,MMPM\nGOTO/0,0,0,0.2,0,0.979795897\n"
      "FEDRAT/30,INVERS\nGOTO/20,0,0,0.2,0,0.979795897\nFINI\n";
  const Explained out = explain(text, machine(Transition::kSmooth));
  if (out.run.report.outcome != Outcome::kDone) FAIL() << out.run.report.reason;
  const ExplainedBlock& block = out.at_line(6);  // 20 mm in 2 s
  EXPECT_NEAR(block.programmed_mm_per_s, 10, 1e-9);
  EXPECT_GT(block.by_limit[kFeedLimit], 1.9F);
  EXPECT_NEAR(block.time_s - block.lost_s, 2, 0.01);
}

TEST(ExplainText, HasAColumnForEveryNameAndSharesThatAddUp) {
  const MachineModel model = machine(Transition::kSmooth);
  const Explained out = explain(corner_and_dense(), model);
  const auto columns = [](const std::string& row) {
    return std::count(row.begin(), row.end(), ',');
  };
  const std::string header = explained_header(model);
  for (const ExplainedBlock& block : out.blocks) {
    EXPECT_EQ(columns(to_csv(block, model)), columns(header));
  }
  const std::string text = to_text(out.whole, model);
  EXPECT_NE(text.find("held by"), std::string::npos) << text;
  EXPECT_NE(text.find("bend"), std::string::npos) << text;
}

TEST(ExplainPicture, IsDrawnAndNamesWhatHeldTheFeed) {
  const MachineModel model = machine(Transition::kSmooth);
  const Explained out = explain(corner_and_dense(), model);
  FeedPicture picture(model);
  for (int n = 0; n < 3; ++n) {  // more cycles than columns
    for (const ExplainedCycle& cycle : out.cycles) picture.add(cycle);
  }
  const test::Scratch file(".svg");
  const auto error = picture.draw(file.path(), "a corner");
  ASSERT_FALSE(error) << error->text();
  const std::string drawn = test::read_text(file.path());
  EXPECT_NE(drawn.find("feed "), std::string::npos);
  EXPECT_NE(drawn.find("jerk"), std::string::npos);
  EXPECT_NE(drawn.find("programmed"), std::string::npos);
  EXPECT_TRUE(FeedPicture(model).draw(file.path(), "nothing"));
}

}  // namespace
}  // namespace meridian::simulate
