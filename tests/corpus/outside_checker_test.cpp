// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "corpus/simulated_file.hpp"
#include "service/programs/cl/interpreter/run_cl.hpp"

namespace meridian {
namespace {

using test::SimulatedFile;

/// The checker in bench/ of the shared folder shares no code with ours. It takes more than a
/// millisecond a cycle, so that what is checked here is short; docs/recordings.md says how the
/// whole corpus fares.
class OutsideChecker : public testing::Test {
 protected:
  void SetUp() override {
    checker_ = test::shared_folder() / "bench" / "check_recording.py";
    if (!std::filesystem::exists(checker_)) GTEST_SKIP() << checker_ << " is not here";
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) {
      GTEST_SKIP() << "python3-numpy is not installed";
    }
    scratch_ =
        std::filesystem::temp_directory_path() / ("meridian-outside-" + std::to_string(::getpid()));
    std::filesystem::create_directories(scratch_);
  }
  void TearDown() override {
    std::error_code ignored;
    if (!scratch_.empty()) std::filesystem::remove_all(scratch_, ignored);
  }

  /// Exit status of the checker for the recording, on the points of `meridian cl` in the frame of
  /// the kinematics.
  [[nodiscard]] int check(const SimulatedFile& simulated) const {
    const MachineModel& model = simulated.model;
    cl::RunOptions points;
    points.file = simulated.file();
    points.output = scratch_ / "points";
    points.reader = test::corpus_reader();
    points.reader.frame = cl::Frame{model.X_MW.rotation, model.X_MW.origin_mm};
    EXPECT_EQ(cl::run_cl(points, std::cout, std::cerr), 0);
    const std::string python = "/usr/bin/python3 ";
    const std::string dense = scratch_ / "dense";
    EXPECT_EQ(std::system((python + MERIDIAN_SOURCE_DIR "/tests/corpus/dense_points.py '" +
                           points.output + "' '" + dense + "'")
                              .c_str()),
              0);
    write_limits(model);
    char options[256];
    std::snprintf(options, sizeof options,
                  " --l %.17g --e %.17g --h %.17g --cycle-ns %lld --tip-tolerance %g "
                  "--axis-tolerance-deg %g",
                  model.lai.pivot_mm + model.tool_length_mm, model.lai.e_mm, model.lai.h_mm,
                  static_cast<long long>(model.cycle_ns), test::kTipTolerance_mm,
                  test::kAxisTolerance_deg);
    return std::system((python + "'" + checker_.string() + "' '" + simulated.recording().string() +
                        "' '" + dense + "' --limits '" + (scratch_ / "limits.json").string() + "'" +
                        options)
                           .c_str());
  }

  std::filesystem::path checker_, scratch_;

 private:
  void write_limits(const MachineModel& model) const {
    std::ofstream out(scratch_ / "limits.json");
    const char* open = "{";
    for (const auto& [name, limit] :
         {std::pair{"v", &JointLimits::velocity}, std::pair{"a", &JointLimits::acceleration},
          std::pair{"j", &JointLimits::jerk}}) {
      out << open << "\"" << name << "\": [";
      out.precision(17);
      for (int i = 0; i < model.joint_count; ++i) {
        out << (i > 0 ? ", " : "") << model.joints[i].limits.*limit;
      }
      out << "]";
      open = ", ";
    }
    out << "}\n";
  }
};

constexpr std::int64_t kCycle_ns = 4'000'000;

TEST_F(OutsideChecker, PassesAWholeFileWithArcs) {
  const auto file = test::shared_folder() / "cl_corpus" / "makino_ff_Plane_2.cldata";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  EXPECT_EQ(check(SimulatedFile(file, test::lai_at("20,-30,50", kCycle_ns))), 0);
}

TEST_F(OutsideChecker, PassesTheHeadOfAFiveAxisFile) {
  const auto file = test::shared_folder() / "cl_corpus" / "ramsai_1-3_plan_5x_depincage_double.apt";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const auto head = scratch_ / "head.apt";
  test::write_head(file, 60, head);
  EXPECT_EQ(check(SimulatedFile(head, test::lai_at("20,-30,50", kCycle_ns))), 0);
}

/// Where a line turns back sharply from an arc, two ways run side by side: with points a millimetre
/// apart on the line and a tenth of that on the arc the checker takes the wrong one, 80 um off.
TEST_F(OutsideChecker, KeepsItsPlaceWhereALineTurnsBackFromAnArc) {
  const auto part = scratch_ / "part.apt";
  std::ofstream(part) << "UNITS / MM\nFEDRAT / 1000, MMPM\nGOTO / 20, 0, 20, 0, 0, 1\n"
                         "CIRCLE / 0, 0, 20, 0, 0, 1, 20\nGOTO / 0, 20, 20\n"
                         "GOTO / 17.3205, 10, 20\nFINI\n";
  EXPECT_EQ(check(SimulatedFile(part, test::lai_at("0,0,0", kCycle_ns))), 0);
}

TEST_F(OutsideChecker, PassesTheJointsOfAMachineOnAStage) {
  MachineModel model = config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/lai-hybrid.toml");
  model.cycle_ns = kCycle_ns;
  model.transition = Transition::kExactStop;
  const auto part = scratch_ / "part.apt";
  std::ofstream(part) << "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 20, -10, 10, 0, 0, 1\n"
                         "GOTO / 32, 5, 12, 0, 0.28, 0.96\nGOTO / 15, 18, 10, 0.28, 0, 0.96\n"
                         "GOTO / 0, 0, 20, 0.28, 0, 0.96\nCIRCLE / 5, 0, 20, 0, 0, 1, 5\n"
                         "GOTO / 10, 0, 20, 0.28, 0, 0.96\nRAPID\n"
                         "GOTO / -8, 0, 14, 0, 0.1908, 0.98163\nFINI\n";
  const SimulatedFile simulated(part, model);
  EXPECT_EQ(check(simulated), 0);
  const auto report = simulated.check();  // the outside checker knows no sliders
  EXPECT_TRUE(report.passed()) << record::to_text(report);
}

TEST_F(OutsideChecker, RefusesWhatOursRefuses) {
  const auto part = scratch_ / "part.apt";
  std::ofstream(part) << "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0.6, 0.8\n"
                         "GOTO / 90, -40, 20, 0, 0.6, 0.8\nGOTO / 90, -35, 20, 0, 0.6, 0.8\nFINI\n";
  const SimulatedFile simulated(part, test::lai_at("0,0,0", kCycle_ns));
  EXPECT_EQ(check(simulated), 0);
  std::ofstream(part)
      << "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0.6, 0.8\n"
         "GOTO / 90, -40.002, 20, 0, 0.6, 0.8\nGOTO / 90, -35, 20, 0, 0.6, 0.8\nFINI\n";
  EXPECT_NE(check(simulated), 0);
}

}  // namespace
}  // namespace meridian
