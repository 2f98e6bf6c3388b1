// SPDX-License-Identifier: Apache-2.0
// Time from the reference patch to cutter contacts, and from those to the joints of a robot.
#include <benchmark/benchmark.h>

#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/surface/patch_file.hpp"

namespace meridian::surface {
namespace {

void ContactsOfTheReferencePatch(benchmark::State& state) {
  const PatchJob job = load_patch(MERIDIAN_SOURCE_DIR "/deploy/parts/reference-patch.toml");
  for (auto _ : state) benchmark::DoNotOptimize(cover(job.rule, job.cover));
}
BENCHMARK(ContactsOfTheReferencePatch)->Unit(benchmark::kMicrosecond);

/// What the paper's 0.187 s stand for: joints of all 441 contacts, branch and winding followed.
void JointsOfTheReferencePatch(benchmark::State& state) {
  const PatchJob job = load_patch(MERIDIAN_SOURCE_DIR "/deploy/parts/reference-patch.toml");
  MachineModel robot = config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/robot-5r.toml");
  robot.X_MW.origin_mm = Vector3::Zero();
  std::vector<ToolPose> poses;
  const auto path = cover(job.rule, job.cover);
  for (const SurfacePath::Line& line : path->lines) {
    for (const Contact& c : line.contacts) poses.push_back(c.pose);
  }
  for (auto _ : state) {
    JointVector q{};
    for (const ToolPose& pose : poses) {
      const auto solution = solve(robot, robot.tool_length_mm, pose, 0, q);
      if (solution.status != SolveStatus::kOk) state.SkipWithError("out of reach");
      q = solution.q;
    }
    benchmark::DoNotOptimize(q);
  }
}
BENCHMARK(JointsOfTheReferencePatch)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace meridian::surface

BENCHMARK_MAIN();
