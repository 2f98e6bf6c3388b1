// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/units.hpp"
#include "service/analysis/bench/bench_paths.hpp"
#include "service/analysis/bench/bench_run.hpp"
#include "service/host/process/programs.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/cl/cl_reader.hpp"

namespace meridian::bench {
namespace {

double tilt_deg(const ClBlock& block) {
  return units::deg_from_rad(std::atan2(std::hypot(block.axis[0], block.axis[1]), block.axis[2]));
}

TEST(BenchPath, ReadsBackAsItWasMadeWithoutAWarning) {
  for (const std::string& name : path_names()) {
    const std::string text = path_file(name, 25);
    cl::ClReader reader(std::string_view(text), name);
    const auto blocks = path(name, 25);
    ASSERT_GT(blocks.size(), 5U) << name;
    std::size_t n = 0;
    for (auto block = reader.next(); block && *block && (*block)->kind == BlockKind::kCut;
         block = reader.next(), ++n) {
      ASSERT_LT(n, blocks.size());
      const Vector3 off = to_vector((*block)->tip_mm) - to_vector(blocks[n].tip_mm);
      EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.51e-6);
      EXPECT_DOUBLE_EQ((*block)->feed, 25);
    }
    EXPECT_EQ(n, blocks.size()) << name;
    EXPECT_TRUE(reader.warnings().empty());
  }
}

TEST(BenchPath, IsWhatItsNameSays) {
  const auto near = path("near_pole", 50), rim = path("near_pole_rim", 50);
  EXPECT_NEAR(tilt_deg(near[30]), 0.1, 1e-9);
  EXPECT_NEAR(tilt_deg(near[0]), 15, 1e-9);
  EXPECT_NEAR(rim[7].tip_mm[0] - near[7].tip_mm[0], 350, 1e-9);
  const auto fan = path("fan", 50);
  EXPECT_NEAR(fan[10].axis[2], 1, 1e-12) << "not through the pole";
  const auto dome = path("dome", 50);
  ASSERT_EQ(dome.size(), 5001U);
  EXPECT_NEAR(tilt_deg(dome.front()), 1, 1e-9);
  EXPECT_NEAR(tilt_deg(dome.back()), 45, 1e-9);
  for (std::size_t n = 1; n < dome.size(); ++n) {
    const double chord = (to_vector(dome[n].tip_mm) - to_vector(dome[n - 1].tip_mm)).norm();
    ASSERT_NEAR(chord, 0.3, 0.02) << n;
  }
  EXPECT_TRUE(path("none", 50).empty());
}

TEST(BenchRun, CutsAPathInsideEveryLimitAndFindsALimitThatIsNotKept) {
  const process::ScratchFolder folder;
  const MachineModel model =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/bench.toml");
  const BenchOptions options{kFeed_mm_per_s, folder.path().string(), true};
  const auto result = run_path("near_pole", model, options);
  ASSERT_TRUE(result.has_value()) << result.error();
  EXPECT_TRUE(result->is_in_order()) << table_row(*result);
  EXPECT_LT(result->plan.program_s, 1.6);
  EXPECT_NE(table_row(*result).find("PASS, certified"), std::string::npos);
  BenchResult spoilt = *result;
  spoilt.certificate->refuted = 1;
  EXPECT_FALSE(spoilt.is_in_order());
  MachineModel cramped = model;
  cramped.joints[4].limits.travel_max = units::rad_from_deg(5);
  cramped.joints[4].limits.travel_min = units::rad_from_deg(-5);
  EXPECT_FALSE(run_path("near_pole", cramped, options).has_value());
}

}  // namespace
}  // namespace meridian::bench
