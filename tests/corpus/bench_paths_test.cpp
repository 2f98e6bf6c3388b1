// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/bench/bench_paths.hpp"

#include <cstdio>
#include <cstdlib>

#include "corpus/simulated_file.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/host/process/programs.hpp"
#include "support/simulated_run.hpp"
#include "support/text_file.hpp"

/// The benchmark paths on deploy/machines/bench.toml: time from the first to
/// the last block, approach left out, every limit and tolerance checked.
namespace meridian {
namespace {

struct BenchRun {
  const char* path;
  PolePolicy policy;
  double override_ramp_s;  ///< 1 is the default; 1000 keeps next to nothing for the override
  double optimum_s;        ///< jerk-limited, under the same limits on the path; 0: none is known
  double max_s;            ///< what it took when it was last looked at, and up to 2 %: no budget
};

std::string name_of(const BenchRun& run) {
  std::string name = run.path;
  if (run.policy == PolePolicy::kExact) name += "_exact";
  if (run.override_ramp_s > 1) name += "_without_reserve";
  return name;
}

void PrintTo(const BenchRun& run, std::ostream* out) { *out << name_of(run); }

class BenchPaths : public testing::TestWithParam<BenchRun> {};

TEST_P(BenchPaths, IsCutInTimeInsideEveryLimitAndTolerance) {
  const BenchRun& one = GetParam();
  MachineModel model =
      config::load_machine(std::string(MERIDIAN_SOURCE_DIR) + "/deploy/machines/bench.toml");
  model.pole_policy = one.policy;
  model.override_ramp_s = one.override_ramp_s;
  const std::string text = bench::path_file(one.path, bench::kFeed_mm_per_s);
  certify::Certifier certifier(model);
  simulate::SimulateOptions options;
  constexpr double kCertified_s = 30;  // longer ones cost more than they add
  if (one.max_s < kCertified_s) options.certifier = &certifier;
  const test::SimulatedRun run = test::run_simulation(text, model, options);
  EXPECT_TRUE(certifier.certificate().is_given()) << to_text(certifier.certificate(), model);
  ASSERT_EQ(run.report.outcome, simulate::Outcome::kDone) << run.report.reason;
  const test::TextFile recording{"", ".csv"};
  const record::CheckReport verdict = test::check_records(run.records, test::path_of(text, model),
                                                          model, {}, recording.path().string());
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
  std::printf("%-26s %8.3f s; relaxed %llu times, at most %.4f deg; computed in %.2f s\n",
              name_of(one).c_str(), run.report.program_s,
              static_cast<unsigned long long>(run.report.relaxed_count),
              units::deg_from_rad(run.report.largest_deviation_rad), run.report.computing_s);
  EXPECT_LE(run.report.program_s, one.max_s) << "slower than it was";
  if (one.optimum_s == 0) return;
  const probe::Budget budget = probe::load_budget("traversal_time");
  std::printf("  %s\n", to_text(budget, one.optimum_s).c_str());
  EXPECT_TRUE(budget.is_kept(run.report.program_s, one.optimum_s));
}

constexpr auto kRelax = PolePolicy::kRelax, kExact = PolePolicy::kExact;

INSTANTIATE_TEST_SUITE_P(Files, BenchPaths,
                         testing::Values(BenchRun{"dome", kRelax, 1, 62.79, 62.9},
                                         BenchRun{"blade", kRelax, 1, 26.49, 26.65},
                                         BenchRun{"blade", kRelax, 1000, 26.49, 26.65},
                                         BenchRun{"fan", kRelax, 1, 2.104, 2.12},
                                         BenchRun{"fan", kRelax, 1000, 2.104, 2.12},
                                         BenchRun{"near_pole", kRelax, 1, 1.445, 1.46},
                                         BenchRun{"near_pole_coarse", kRelax, 1, 1.488, 1.51},
                                         BenchRun{"near_pole_rim", kRelax, 1, 1.449, 1.47},
                                         BenchRun{"near_pole", kExact, 1, 3.947, 3.98},
                                         BenchRun{"near_pole_coarse", kExact, 1, 3.941, 3.98},
                                         BenchRun{"near_pole_rim", kExact, 1, 4.24, 4.28}),
                         [](const auto& run) { return name_of(run.param); });

/// The generator in bench/ of the shared folder shares no code with ours.
TEST(BenchPathsOfTheFolder, AreOursButForRounding) {
  const auto maker = test::shared_folder() / "bench" / "paths.py";
  if (!std::filesystem::exists(maker)) GTEST_SKIP() << maker << " is not here";
  if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "python3-numpy is not installed";
  }
  const process::ScratchFolder folder;
  const std::string command =
      "/usr/bin/python3 '" + maker.string() + "' '" + folder.path().string() + "' >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  for (const std::string& name : bench::path_names()) {
    const std::string ours = bench::path_file(name, bench::kFeed_mm_per_s);
    const std::string theirs = test::read_text(folder.path() / (name + ".apt"));
    cl::ClReader mine(std::string_view(ours), name), other(std::string_view(theirs), name);
    std::size_t count = 0;
    for (;; ++count) {
      const auto a = mine.next(), b = other.next();
      ASSERT_TRUE(a && b) << name << " " << count;
      ASSERT_EQ(a->has_value(), b->has_value()) << name << ": one ends at " << count;
      if (!*a) break;
      EXPECT_EQ((*a)->kind, (*b)->kind);
      const Vector3 tip = to_vector((*a)->tip_mm) - to_vector((*b)->tip_mm);
      const Vector3 axis = to_vector((*a)->axis) - to_vector((*b)->axis);
      EXPECT_LE(tip.cwiseAbs().maxCoeff(), 1.01e-6) << name << " " << count;
      EXPECT_LE(axis.cwiseAbs().maxCoeff(), 2e-9) << name << " " << count;
      EXPECT_EQ((*a)->feed, (*b)->feed);
    }
    EXPECT_GT(count, 6U);
  }
}

}  // namespace
}  // namespace meridian
