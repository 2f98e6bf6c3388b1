// SPDX-License-Identifier: Apache-2.0

/// Axes that wander about the pole, in feed, inverse time and rapids, from rest to rest: check
/// passes what the axis tolerance is used for, and the time is less than without it.
/// MERIDIAN_POLE_RESTS: so many programs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "meridian/units.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/scratch.hpp"
#include "support/simulated_run.hpp"

namespace meridian::simulate {
namespace {

using test::run_simulation;
using test::SimulatedRun;

/// Lines of `step_mm` along x to axes that go by a few hundredths of a degree from one to the next.
[[nodiscard]] std::string wander(std::uint32_t seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> by(0, units::rad_from_deg(0.06));
  std::uniform_real_distribution<double> share(0, 1);
  const double step_mm = std::pow(10, 1.5 * share(engine) - 1);
  std::string text = "UNITS / MM\nMULTAX / ON\nFEDRAT / 3000, MMPM\n";
  double x = 0, y = 0;
  for (int n = 0; n < 30; ++n) {
    x = 0.8 * x + by(engine);
    y = 0.8 * y + by(engine);
    const double draw = share(engine);
    char line[160];
    if (draw < 0.3) {
      std::snprintf(line, sizeof line, "FEDRAT / INVERS, %.4f\n",
                    60 * std::pow(10, 5 * draw - 0.5));
      text += line;
    } else if (draw < 0.5) {
      text += "FEDRAT / 3000, MMPM\n";
    } else if (draw < 0.6) {
      text += "RAPID\n";
    }
    const double norm = std::hypot(1, std::hypot(x, y));
    std::snprintf(line, sizeof line, "GOTO / %.9f, 30, 20, %.12f, %.12f, %.12f\n", 20 + step_mm * n,
                  x / norm, y / norm, 1 / norm);
    text += line;
  }
  return text + "FINI\n";
}

TEST(PoleRestCheck, PassesWhatTheToleranceAboutThePoleIsUsedFor) {
  MachineModel model = test::lai_machine();
  model.transition = Transition::kExactStop;
  MachineModel exact = model;
  exact.pole_policy = PolePolicy::kExact;
  const test::Scratch recording(".csv");
  const auto programs = test::number_of<std::uint32_t>("MERIDIAN_POLE_RESTS", test::draws(12));
  double relaxed_s = 0, exact_s = 0, worst = 0;
  for (std::uint32_t seed = 1; seed <= programs; ++seed) {
    const std::string text = wander(seed);
    const SimulatedRun run = run_simulation(text, model);
    ASSERT_EQ(run.report.outcome, Outcome::kDone) << seed << ": " << run.report.reason;
    const record::CheckReport report = test::check_records(
        run.records, test::path_of(text.c_str(), model, {}), model, {}, recording.path());
    EXPECT_TRUE(report.passed()) << "seed " << seed << '\n' << to_text(report);
    const SimulatedRun whole = run_simulation(text, exact);
    if (whole.report.outcome != Outcome::kDone) continue;  // out of C's travel
    relaxed_s += run.report.program_s;
    exact_s += whole.report.program_s;
    worst = std::max(worst, run.report.program_s / whole.report.program_s);
  }
  std::printf("%u programs: %.2f s, without the tolerance %.2f s; worst share %.4f\n", programs,
              relaxed_s, exact_s, worst);
  EXPECT_LT(relaxed_s, 0.95 * exact_s);
  EXPECT_LT(worst, 1.1);
}

}  // namespace
}  // namespace meridian::simulate
