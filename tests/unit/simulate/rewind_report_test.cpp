// SPDX-License-Identifier: Apache-2.0

/// A spiral that C has no travel for, simulated: its recording passes the check, and spoilt it does
/// not; the report and the explanation say what was done.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "service/analysis/simulate/explainer.hpp"
#include "support/machines.hpp"
#include "support/scratch.hpp"
#include "support/simulated_run.hpp"

namespace meridian::simulate {
namespace {

using record::Finding;

constexpr std::size_t kLift = 2, kC = 3, kTilt = 4;  // joints of the Lai machine

MachineModel short_travel() {
  MachineModel model = test::lai_machine();
  model.joints[3].limits.travel_min = units::rad_from_deg(-250);
  model.joints[3].limits.travel_max = units::rad_from_deg(250);
  model.rewind_policy = RewindPolicy::kRetract;
  model.rewind_retract_mm = 20;
  return model;
}

/// Turns round a cone, 3 deg a block. Behind the first 30 blocks it leans by `lean` more a block.
std::string spiral(int blocks, double lean = 0) {
  std::string text = "UNITS/MM\nMULTAX/ON\nFEDRAT/3000,MMPM\n";
  for (int n = 0; n <= blocks; ++n) {
    const double azimuth = units::rad_from_deg(3.0 * n);
    const double tilt = 0.4 + lean * std::max(0, n - 30);
    char line[160];
    std::snprintf(line, sizeof line, "GOTO/%.6f,%.6f,%.6f,%.9f,%.9f,%.9f\n", 20 * std::cos(azimuth),
                  20 * std::sin(azimuth), 30 - 0.01 * n, std::sin(tilt) * std::cos(azimuth),
                  std::sin(tilt) * std::sin(azimuth), std::cos(tilt));
    text += line;
  }
  return text + "FINI\n";
}

class SimulatedRewind : public ::testing::TestWithParam<Transition> {
 protected:
  SimulatedRewind() { model.transition = GetParam(); }

  [[nodiscard]] record::CheckReport check(const std::vector<CycleRecord>& records) {
    return test::check_records(records, test::path_of(text, model), model, {}, file.path());
  }
  [[nodiscard]] static bool has(const record::CheckReport& report, Finding::Kind kind) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [kind](const Finding& finding) { return finding.kind == kind; });
  }
  /// The record of a rewind in which that joint is fastest.
  [[nodiscard]] static std::size_t find_in(const std::vector<CycleRecord>& records,
                                           std::size_t joint) {
    std::size_t best = 0;
    double max = 0;
    for (std::size_t n = 1; n < records.size(); ++n) {
      if (records[n].motion != MotionKind::kRewind) continue;
      const double moved = std::abs(records[n].joints[joint] - records[n - 1].joints[joint]);
      if (moved > max) {
        max = moved;
        best = n;
      }
    }
    return best;
  }

  MachineModel model = short_travel();
  std::string text = spiral(240);  // two turns
  test::Scratch file{".csv"};
};

TEST_P(SimulatedRewind, PassesTheCheckAndIsReported) {
  double rewind_s = 0;
  Explainer explainer(model,
                      [&rewind_s](const ExplainedBlock& block) {
                        rewind_s += block.by_cause[static_cast<std::size_t>(Cause::kRewind)];
                      },
                      {});
  SimulateOptions options;
  options.explainer = &explainer;
  const test::SimulatedRun run = test::run_simulation(text, model, options);
  ASSERT_EQ(run.report.outcome, Outcome::kDone) << run.report.reason;
  ASSERT_GE(run.report.rewind_count, 1U);
  EXPECT_NE(to_text(run.report, model).find("would leave its travel"), std::string::npos);
  const record::CheckReport report = check(run.records);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.rewinds, run.report.rewind_count);
  const auto cycles =
      std::count_if(run.records.begin(), run.records.end(),
                    [](const CycleRecord& record) { return record.motion == MotionKind::kRewind; });
  EXPECT_NEAR(rewind_s, 1e-3 * static_cast<double>(cycles), 0.05);
}

TEST_P(SimulatedRewind, IsFoundOutWhereItIsNoneOfTheDeclaredKind) {
  const test::SimulatedRun run = test::run_simulation(text, model);
  ASSERT_EQ(run.report.outcome, Outcome::kDone) << run.report.reason;
  auto sideways = run.records;
  sideways[find_in(run.records, kLift)].joints[0] += 0.5;
  EXPECT_TRUE(has(check(sideways), Finding::Kind::kRewind)) << "off the line";
  auto with_c = run.records;
  with_c[find_in(run.records, kC)].joints[1] += 0.5;
  EXPECT_TRUE(has(check(with_c), Finding::Kind::kRewind)) << "another joint moves with C";
  model.rewind_retract_mm = 25;
  EXPECT_TRUE(has(check(run.records), Finding::Kind::kRewind)) << "not off as far as declared";
  model.rewind_policy = RewindPolicy::kRefuse;
  EXPECT_TRUE(has(check(run.records), Finding::Kind::kRewind)) << "not declared";
}

TEST_P(SimulatedRewind, ToTheOtherBranchIsFoundOutWhereItIsNoneOfTheDeclaredKind) {
  model.joints[kC].limits.travel_min = units::rad_from_deg(-200);
  model.joints[kC].limits.travel_max = units::rad_from_deg(200);
  text = spiral(155);
  const test::SimulatedRun run = test::run_simulation(text, model);
  ASSERT_EQ(run.report.outcome, Outcome::kDone) << run.report.reason;
  ASSERT_EQ(run.report.rewinds.size(), 1U);
  ASSERT_TRUE(run.report.rewinds[0].is_other_branch());
  EXPECT_TRUE(check(run.records).passed()) << to_text(check(run.records));
  const std::size_t tilted = find_in(run.records, kTilt);
  auto sideways = run.records;
  sideways[tilted].joints[0] += 0.5;
  EXPECT_TRUE(has(check(sideways), Finding::Kind::kRewind)) << "the tip moves on the way";
  auto astray = run.records;
  astray[tilted].joints[kC] += 0.1;
  EXPECT_TRUE(has(check(astray), Finding::Kind::kRewind)) << "the axis leaves the way to the pole";
  model.rewind_retract_mm = 25;
  EXPECT_TRUE(has(check(run.records), Finding::Kind::kRewind)) << "not off as far as declared";
}

/// One branch has no C for the begin, the other no tilt for the end.
TEST_P(SimulatedRewind, ForTheTiltNamesItAndPassesTheCheck) {
  text = spiral(40, 0.02);
  const auto at = [&](double azimuth) {
    const Vector3 tip(20 * std::cos(azimuth), 20 * std::sin(azimuth), 30);
    const Vector3 axis(std::sin(0.4) * std::cos(azimuth), std::sin(0.4) * std::sin(azimuth),
                       std::cos(0.4));
    return solve(model, model.tool_length_mm, ToolPose{tip, axis}, 0, JointVector{}).q;
  };
  const JointVector begin = at(0);
  const bool is_up = at(0.1)[kC] > begin[kC], is_tilt_up = begin[kTilt] > 0;
  JointLimits& c = model.joints[kC].limits;
  c.travel_max = begin[kC] + units::rad_from_deg(is_up ? 150 : 140);
  c.travel_min = c.travel_max - units::rad_from_deg(290);
  JointLimits& tilt = model.joints[kTilt].limits;
  tilt.travel_max = is_tilt_up ? 0.5 : 1;
  tilt.travel_min = is_tilt_up ? -1 : -0.5;
  const test::SimulatedRun run = test::run_simulation(text, model);
  ASSERT_EQ(run.report.outcome, Outcome::kDone) << run.report.reason;
  ASSERT_EQ(run.report.rewinds.size(), 1U);
  EXPECT_TRUE(run.report.rewinds[0].is_other_branch());
  const std::string says = model.joints[kTilt].name + " would leave its travel";
  EXPECT_NE(to_text(run.report, model).find(says), std::string::npos);
  EXPECT_TRUE(check(run.records).passed()) << to_text(check(run.records));
}

/// A wire that lost two rows in the very moment in which the tool leaves, and where it comes back.
TEST_P(SimulatedRewind, IsCheckedWhereRowsAreMissingAtItsEnds) {
  const test::SimulatedRun run = test::run_simulation(text, model);
  ASSERT_EQ(run.report.outcome, Outcome::kDone) << run.report.reason;
  const auto is_rewind = [](const CycleRecord& record) {
    return record.motion == MotionKind::kRewind;
  };
  auto records = run.records;
  const auto first = std::find_if(records.begin(), records.end(), is_rewind);
  const auto after = std::find_if_not(first, records.end(), is_rewind);
  records.erase(after - 1, after + 1);
  records.erase(first - 1, first + 1);
  record::CheckOptions options;
  options.max_missing = 4;
  const auto check = [&] {
    return test::check_records(records, test::path_of(text, model), model, options, file.path());
  };
  EXPECT_TRUE(check().passed()) << to_text(check());
  model.rewind_retract_mm = 20.1;
  EXPECT_TRUE(has(check(), Finding::Kind::kRewind)) << "not off as far as declared";
}

INSTANTIATE_TEST_SUITE_P(Both, SimulatedRewind,
                         ::testing::Values(Transition::kExactStop, Transition::kSmooth),
                         [](const auto& which) {
                           return which.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::simulate
