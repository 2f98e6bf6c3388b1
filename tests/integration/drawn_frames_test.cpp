// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>

#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/pose_solutions.hpp"
#include "service/protocol/station/preflight.hpp"
#include "support/draws.hpp"
#include "support/simulated_run.hpp"
#include "support/text_file.hpp"

/// Work frames anywhere: preflight, planner with simulation, and `pose` say the same of what fits.
/// MERIDIAN_SETUP_FRAMES=1000 in the environment for more of them.
namespace meridian {
namespace {

constexpr const char* kPart = "PARTNO FRAMES\nUNITS/MM\nRAPID\nGOTO/12,-7,5,0.28,0.0,0.96\nFINI\n";
const ToolPose kPose{Vector3(12, -7, 5), Vector3(0.28, 0.0, 0.96)};

MachineModel placed(const MachineModel& machine, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> position(-900, 900), height(-800, 600), turn(-60, 60);
  RigidTransform frame;
  frame.origin_mm = Vector3(position(engine), position(engine), height(engine));
  frame.rotation = config::rotation_from_deg(turn(engine), turn(engine), 3 * turn(engine));
  MachineModel out = machine;
  config::place_workpiece(out, frame);
  return out;
}

TEST(DrawnFrames, FitInPreflightPlannerSimulationAndPoseAlike) {
  const int frames = test::number_of("MERIDIAN_SETUP_FRAMES", 50);
  constexpr unsigned kSeed = 20261127;
  std::mt19937_64 engine(kSeed);
  const test::TextFile part(kPart);
  int fit = 0;
  for (int n = 0; n < frames; ++n) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", frame " << n);
    static const MachineModel kMachine =
        config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
    const MachineModel model = placed(kMachine, engine);
    const auto solutions = inspect::solve_all(model, kPose);
    const bool by_pose = std::any_of(solutions.begin(), solutions.end(),
                                     [](const auto& solution) { return solution.outside < 0; });
    const bool by_preflight =
        !stream::preflight(part.path(), {}, stream::PreflightMachine{model, ToolTable(), ""})
             .is_refused;
    cl::ClReader reader(kPart, "part.apt");
    const auto report = simulate::simulate(reader, "part.apt", model, {}, {}, [](const auto&) {});
    const bool by_simulation = report.outcome == simulate::Outcome::kDone;
    ASSERT_EQ(by_preflight, by_pose);
    ASSERT_EQ(by_simulation, by_pose) << report.reason;
    fit += by_pose ? 1 : 0;
  }
  std::printf("%d of %d frames fit\n", fit, frames);
  EXPECT_GT(fit, frames / 10);
  EXPECT_LT(fit, frames - frames / 10);
}

}  // namespace
}  // namespace meridian
