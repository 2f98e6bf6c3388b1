// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "corpus/simulated_file.hpp"
#include "support/text_file.hpp"

namespace meridian {
namespace {

using record::CheckReport;
using record::Finding;
using test::SimulatedFile;

struct CorpusRun {
  const char* name;
  const char* frame;  ///< puts the workpiece inside travel
  std::uint64_t motion_blocks;
  std::int64_t cycle_ns;  ///< 4 ms where the run takes long
  int lines = 0;          ///< of the file that are cut, 0: all
};

void PrintTo(const CorpusRun& run, std::ostream* out) { *out << run.name; }

class SimulatedCorpus : public testing::TestWithParam<CorpusRun> {};

class SmoothCorpus : public testing::TestWithParam<CorpusRun> {};

/// Simulates the file, or its head, and checks what came out.
void expect_whole_cut(const CorpusRun& run, Transition transition) {
  auto file = test::shared_folder() / "cl_corpus" / run.name;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const test::TextFile head{"", ".apt"};
  if (run.lines > 0) {
    test::write_head(file, run.lines, head.path());
    file = head.path();
  }
  MachineModel machine = test::lai_at(run.frame, run.cycle_ns);
  machine.transition = transition;
  const SimulatedFile simulated(file, machine);
  std::fputs(to_text(simulated.report, simulated.model).c_str(), stdout);
  ASSERT_EQ(simulated.report.outcome, simulate::Outcome::kDone);
  EXPECT_EQ(simulated.report.motion_blocks, run.motion_blocks);
  const CheckReport verdict = simulated.check();
  std::fputs(to_text(verdict).c_str(), stdout);
  EXPECT_TRUE(verdict.passed());
  EXPECT_EQ(verdict.motion_blocks, run.motion_blocks);
  EXPECT_EQ(verdict.vertices_in_gaps, 0U);
  EXPECT_GE(verdict.vertices, run.motion_blocks);
}

TEST_P(SimulatedCorpus, IsCutFromFirstToLastBlockInsideEveryLimit) {
  expect_whole_cut(GetParam(), Transition::kExactStop);
}

TEST_P(SmoothCorpus, IsCutWithoutStoppingInsideEveryLimitAndTolerance) {
  expect_whole_cut(GetParam(), Transition::kSmooth);
}

constexpr std::int64_t kMs = 1'000'000;

std::string name_of(const testing::TestParamInfo<CorpusRun>& file) {
  std::string name = file.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

// Motion blocks: the GOTO counts of SOURCES.md; in nx_coremill one arc ends in a line of its own.
INSTANTIATE_TEST_SUITE_P(
    Files, SimulatedCorpus,
    testing::Values(CorpusRun{"ramsai_1-1_plan_3x.apt", "20,-30,50", 206, 4 * kMs},
                    CorpusRun{"ramsai_1-2_plan_5x_depincage_lateral.apt", "20,-30,50", 208, kMs},
                    CorpusRun{"ramsai_1-3_plan_5x_depincage_double.apt", "20,-30,50", 708, kMs},
                    CorpusRun{"ramsai_2-1_calotte_3x.apt", "20,-30,50", 605, kMs},
                    CorpusRun{"nx_coremill.cls", "-150,-100,0", 3131, 4 * kMs},
                    CorpusRun{"nx_simple_block.cls", "20,-30,50", 104, kMs},
                    CorpusRun{"makino_ff_Plane_1.cldata", "20,-30,50", 205, kMs},
                    CorpusRun{"makino_ff_Plane_2.cldata", "20,-30,50", 62, kMs}),
    name_of);

// Of those that take long the head alone; docs/recordings.md says how the whole corpus fares.
INSTANTIATE_TEST_SUITE_P(
    Files, SmoothCorpus,
    testing::Values(
        CorpusRun{"ramsai_1-1_plan_3x.apt", "20,-30,50", 20, 4 * kMs, 25},
        CorpusRun{"ramsai_1-2_plan_5x_depincage_lateral.apt", "20,-30,50", 208, 4 * kMs},
        CorpusRun{"ramsai_1-3_plan_5x_depincage_double.apt", "20,-30,50", 147, kMs, 300},
        CorpusRun{"ramsai_2-1_calotte_3x.apt", "20,-30,50", 25, 4 * kMs, 52},
        CorpusRun{"nx_coremill.cls", "-150,-100,0", 46, 4 * kMs, 60},
        CorpusRun{"nx_simple_block.cls", "20,-30,50", 104, 4 * kMs},
        CorpusRun{"makino_ff_Plane_1.cldata", "20,-30,50", 205, 4 * kMs},
        CorpusRun{"makino_ff_Plane_2.cldata", "20,-30,50", 62, kMs}),
    name_of);

/// What a recording is changed to, and what the checker must find then.
class MutatedRecording : public testing::Test {
 protected:
  void SetUp() override {
    const auto file = test::shared_folder() / "cl_corpus" / "makino_ff_Plane_2.cldata";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
    simulated_ = std::make_unique<SimulatedFile>(file, test::lai_at("20,-30,50", kMs));
    auto reader = record::RecordingReader::open(simulated_->recording(), simulated_->model);
    record::RecordingRow row;
    while (*reader->next(row)) {
      CycleRecord record;
      record.setpoint.cycle = row.cycle;
      record.setpoint.due_ns = row.due_ns;
      std::copy_n(row.velocity.begin(), record.setpoint.velocity.size(),
                  record.setpoint.velocity.begin());
      record.setpoint.line = row.line;
      record.setpoint.flags = row.flags;
      record.joints = row.joints;
      record.motion = row.kind;
      record.state = row.state;
      rows_.push_back(record);
    }
    // The middle of the longest run of rows of one cut.
    std::size_t begin = 0, longest = 0;
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      if (rows_[i].setpoint.line != rows_[begin].setpoint.line) begin = i;
      if (rows_[i].motion != MotionKind::kCut || i - begin < longest) continue;
      longest = i - begin;
      middle_ = begin + longest / 2;
    }
    ASSERT_GT(longest, 400U);
  }

  [[nodiscard]] CheckReport check() {
    auto writer = record::RecordingWriter::create(simulated_->recording(), simulated_->model);
    for (const CycleRecord& row : rows_) EXPECT_TRUE(writer->write(row));
    EXPECT_TRUE(writer->close());
    return simulated_->check();
  }

  [[nodiscard]] static bool has(const CheckReport& report, Finding::Kind kind) {
    for (const Finding& finding : report.findings) {
      if (finding.kind == kind) return true;
    }
    return false;
  }

  std::unique_ptr<SimulatedFile> simulated_;
  std::vector<CycleRecord> rows_;
  std::size_t middle_ = 0;
};

TEST_F(MutatedRecording, PassesAsItIs) { EXPECT_TRUE(check().passed()); }

TEST_F(MutatedRecording, IsRefusedWhereTheTipIsTwoMicrometresOff) {
  for (int i = -150; i <= 150; ++i) {  // smooth: no joint limit notices
    const double x = i / 150.0;
    rows_[middle_ + i].joints[2] += 0.002 * std::pow(1 - x * x, 4);
  }
  const CheckReport report = check();
  EXPECT_TRUE(has(report, Finding::Kind::kTip)) << to_text(report);
  EXPECT_FALSE(has(report, Finding::Kind::kJerk)) << to_text(report);
}

TEST_F(MutatedRecording, IsRefusedForAJerkSpikeInsideTheTolerance) {
  rows_[middle_].joints[2] += 0.0009;
  const CheckReport report = check();
  EXPECT_TRUE(has(report, Finding::Kind::kJerk)) << to_text(report);
  EXPECT_FALSE(has(report, Finding::Kind::kTip)) << to_text(report);
}

TEST_F(MutatedRecording, IsRefusedWhereAVertexIsCut) {
  // From 40 ms before the sharpest vertex straight to 40 ms behind it.
  std::size_t vertex = 0;
  double sharpest = 0;
  for (std::size_t i = 4000; i + 100 < rows_.size(); ++i) {
    if (rows_[i].setpoint.line == rows_[i - 1].setpoint.line) continue;
    double bend = 0;
    for (int joint = 0; joint < 3; ++joint) {
      bend += std::abs(rows_[i - 40].joints[joint] - 2 * rows_[i].joints[joint] +
                       rows_[i + 40].joints[joint]);
    }
    if (bend <= sharpest) continue;
    sharpest = bend;
    vertex = i;
  }
  const std::size_t from = vertex - 40, to = vertex + 40;
  for (std::size_t i = from + 1; i < to; ++i) {
    const double t = static_cast<double>(i - from) / static_cast<double>(to - from);
    for (int joint = 0; joint < 5; ++joint) {
      rows_[i].joints[joint] = (1 - t) * rows_[from].joints[joint] + t * rows_[to].joints[joint];
    }
  }
  const CheckReport report = check();
  EXPECT_TRUE(has(report, Finding::Kind::kVertex) || has(report, Finding::Kind::kTip))
      << to_text(report);
}

TEST_F(MutatedRecording, IsRefusedForATipFasterThanTheFeed) {
  // Every second row of a stretch left out, the others closed up: twice the feed.
  std::vector<CycleRecord> faster(rows_.begin(),
                                  rows_.begin() + static_cast<std::ptrdiff_t>(middle_));
  for (std::size_t i = middle_; i < rows_.size(); i += i < middle_ + 100 ? 2 : 1) {
    faster.push_back(rows_[i]);
    faster.back().setpoint.cycle = faster[faster.size() - 2].setpoint.cycle + 1;
    faster.back().setpoint.due_ns = faster[faster.size() - 2].setpoint.due_ns + kMs;
  }
  rows_ = faster;
  const CheckReport report = check();
  EXPECT_TRUE(has(report, Finding::Kind::kFeed)) << to_text(report);
  EXPECT_NEAR(report.feed.value, 2, 0.01);
  EXPECT_FALSE(has(report, Finding::Kind::kTip)) << to_text(report);
}

TEST_F(MutatedRecording, IsRefusedForAMissingCycle) {
  rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(middle_));
  const CheckReport report = check();
  ASSERT_EQ(report.findings.size(), 1U) << to_text(report);
  EXPECT_EQ(report.findings[0].kind, Finding::Kind::kMissingCycles);
}

}  // namespace
}  // namespace meridian
