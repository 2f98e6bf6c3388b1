// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scratch.hpp"
#include "support/machines.hpp"
#include "support/sample_recording.hpp"

namespace meridian::record {
namespace {

using test::cut_to;
using test::SampleRun;
using test::Scratch;

class Compare : public ::testing::Test {
 protected:
  Compare()
      : records(
            SampleRun(model, {cut_to(1, {80, -40, 20}, 0.3, 30), cut_to(2, {82, -40, 20}, 0.3, 30),
                              cut_to(3, {82, -37, 19}, 0.35, 30)})
                .records),
        live(records) {}

  [[nodiscard]] ComparisonReport run() {
    const Scratch one(".csv"), two(".csv");
    RecordingReader a = test::write_and_open(one.path(), model, live);
    RecordingReader b = test::write_and_open(two.path(), model, records);
    auto report = compare(a, b, model);
    EXPECT_TRUE(report.has_value());
    return *report;
  }

  MachineModel model = test::lai_machine();
  std::vector<CycleRecord> records, live;
};

TEST_F(Compare, CallsTheSameMotionTheSameWhateverWentBeforeIt) {
  EXPECT_TRUE(run().is_same());
  std::vector<CycleRecord> waiting(500, live.front());
  live.insert(live.begin(), waiting.begin(), waiting.end());
  for (std::size_t i = 0; i < live.size(); ++i) live[i].setpoint.cycle = 3 * 1000 + i;
  for (int i = 0; i < 300; ++i) {  // drives off: setpoint = feedback, which trembles
    live[i].setpoint.flags = 0;
    live[i].joints[0] += 1e-6 * (i % 3);
  }
  const ComparisonReport report = run();
  EXPECT_TRUE(report.is_same()) << to_text(report, "a", "b", model);
  EXPECT_EQ(report.compared, records.size() - 20);
}

TEST_F(Compare, LetsCyclesBeMissing) {
  live.erase(live.begin() + 60, live.begin() + 64);
  live.erase(live.begin() + 200);
  const ComparisonReport report = run();
  EXPECT_TRUE(report.is_same()) << to_text(report, "a", "b", model);
  EXPECT_EQ(report.gaps_a, 5U);
  EXPECT_EQ(report.only_b, 5U);
}

TEST_F(Compare, LetsTheFirstMovingCyclesBeMissing) {
  live.erase(live.begin() + 15, live.begin() + 24);
  const ComparisonReport report = run();
  EXPECT_TRUE(report.is_same()) << to_text(report, "a", "b", model);
}

TEST_F(Compare, LetsARestBeLonger) {
  std::size_t rest = 20;
  while (live[rest].setpoint.line != 3) ++rest;
  const std::vector<CycleRecord> waiting(40, live[rest - 1]);
  live.insert(live.begin() + static_cast<std::ptrdiff_t>(rest), waiting.begin(), waiting.end());
  for (std::size_t i = 0; i < live.size(); ++i) live[i].setpoint.cycle = i;
  const ComparisonReport report = run();
  EXPECT_TRUE(report.is_same()) << to_text(report, "a", "b", model);
}

TEST_F(Compare, MatchesARestWithTheRestOfItsOwnBlock) {
  std::size_t rest = 20;
  while (live[rest].setpoint.line != 3) ++rest;
  // Block 3 begins at the plan time at which block 2 ended; evaluated anew, a joint differs by
  // rounding.
  for (auto* run : {&records, &live}) {
    (*run)[rest].plan_time_s = (*run)[rest - 1].plan_time_s;
    (*run)[rest].joints = (*run)[rest - 1].joints;
    (*run)[rest].joints[0] = std::nextafter((*run)[rest].joints[0], 1e9);
  }
  const std::vector<CycleRecord> waiting(40, live[rest - 1]);
  live.insert(live.begin() + static_cast<std::ptrdiff_t>(rest), waiting.begin(), waiting.end());
  for (std::size_t i = 0; i < live.size(); ++i) live[i].setpoint.cycle = i;
  const ComparisonReport report = run();
  EXPECT_TRUE(report.is_same()) << to_text(report, "a", "b", model);
}

TEST_F(Compare, SeesOneBit) {
  double& value = live[100].joints[1];
  value = std::nextafter(value, std::numeric_limits<double>::infinity());
  const ComparisonReport report = run();
  EXPECT_FALSE(report.is_same());
  EXPECT_EQ(report.different, 1U);
  EXPECT_EQ(report.first_joint, 1);
  EXPECT_EQ(report.first_difference_a, live[100].setpoint.cycle);
  EXPECT_NE(to_text(report, "a", "b", model).find("DIFFERENT"), std::string::npos);
}

TEST_F(Compare, SeesMotionThatOnlyOneHas) {
  live.resize(150);
  EXPECT_FALSE(run().is_same());
  live = records;
  for (std::size_t i = 100; i < live.size(); ++i) live[i].plan_time_s -= 0.0004;  // a hold
  EXPECT_FALSE(run().is_same());
}

TEST_F(Compare, CallsRecordingsWithoutMotionDifferent) {
  live.resize(10);
  EXPECT_FALSE(run().is_same());
}

}  // namespace
}  // namespace meridian::record
