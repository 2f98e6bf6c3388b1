// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "meridian/units.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// Cuts that end on the pole itself, as a spiral onto the top of a dome does: there the path has no
/// direction for the redundant joint, but the one with which it comes.
namespace meridian::test::onto_pole {
namespace {

struct Spiral {
  double tilt_deg = 0, step_deg = 0;  ///< at its begin, and by which it goes round at each point
  int points = 0;
};

std::vector<ClBlock> onto_the_pole(const Spiral& spiral) {
  constexpr double kRadius_mm = 30, kUp_mm = 40;
  std::vector<ClBlock> blocks;
  const auto add = [&](const ToolPose& pose) -> ClBlock& {
    blocks.push_back(cut_block(static_cast<int>(blocks.size()), pose));
    blocks.back().feed = 50;
    return blocks.back();
  };
  for (int n = 0; n <= spiral.points; ++n) {
    const double tilt = units::rad_from_deg(spiral.tilt_deg) * (1 - 1.0 * n / spiral.points);
    const double azimuth = units::rad_from_deg(30 + spiral.step_deg * n);
    const Vector3 axis(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                       std::cos(tilt));
    add({kRadius_mm * (axis - Vector3::UnitZ()), axis});
  }
  add({kUp_mm * Vector3::UnitZ(), Vector3::UnitZ()}).kind = BlockKind::kRapid;
  end_program(blocks);
  return blocks;
}

class OntoPole : public testing::TestWithParam<std::tuple<Transition, PolePolicy>> {};

TEST_P(OntoPole, EndsThereInsideEveryLimitAndRestsOnTheJointsOfWhatComesNext) {
  const auto [transition, policy] = GetParam();
  double largest = 0, time_s = 0;
  int refused = 0;
  for (const std::string& name : cases(shipped_machines())) {
    MachineModel model = config::load_machine(shipped_file(name));
    if (redundant_joint(model) < 0) continue;  // a robot's singularities lie elsewhere
    model.pole_policy = policy;
    for (const Spiral& spiral :
         cases({Spiral{5, 3, 10}, {2.5, 25, 23}, {20, 0, 1}, {8, 0, 12}, {15, 10, 60}})) {
      SCOPED_TRACE(testing::Message() << name << ", " << spiral.tilt_deg << " deg in "
                                      << spiral.points << " by " << spiral.step_deg);
      const auto blocks = onto_the_pole(spiral);
      const JointVector start = joints_of(model, blocks[0]);
      const SmoothTrace trace = plan_smooth(model, blocks, start, {transition, 0, 0});
      if (trace.last.reject.code == RejectCode::kTravelBetween) {
        ++refused;  // C has not so many turns
        continue;
      }
      ASSERT_EQ(trace.last.status, PlanStatus::kOk) << static_cast<int>(trace.last.reject.code);
      for (const double cycle_s : {1e-3, 250e-6}) {
        const auto setpoints = sample(model, trace, cycle_s, 0.37, start);
        const LimitUse use = measure_limits(model, setpoints, cycle_s);
        EXPECT_LE(std::max({use.v, use.a, use.j}), 1 + 1e-6) << use.where;
        largest = std::max({largest, use.v, use.a, use.j});
      }
      time_s += trace.duration_s();
    }
  }
  std::printf("%.6f of the limits, %.0f s, %d refused for travel\n", largest, time_s, refused);
  EXPECT_LE(refused, 4);
}

INSTANTIATE_TEST_SUITE_P(
    Of, OntoPole,
    testing::Combine(testing::Values(Transition::kSmooth, Transition::kExactStop),
                     testing::Values(PolePolicy::kRelax, PolePolicy::kExact)),
    [](const auto& run) {
      return std::string(std::get<0>(run.param) == Transition::kSmooth ? "Smooth" : "ExactStop") +
             (std::get<1>(run.param) == PolePolicy::kRelax ? "Relaxed" : "Exact");
    });

}  // namespace
}  // namespace meridian::test::onto_pole
