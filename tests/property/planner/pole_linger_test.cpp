// SPDX-License-Identifier: Apache-2.0

/// Paths that linger so close to the pole that the axis tolerance leaves the redundant joint free:
/// they run through their blocks like any other.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_linger {
namespace {

constexpr double kLimit = 1 + 1e-6;

/// All of the cases; under a sanitizer, which sees the same code in one, the last.
template <class Case>
std::vector<Case> cases(std::vector<Case> all) {
  if constexpr (!kIsTimed) all.erase(all.begin(), all.end() - 1);
  return all;
}

/// Blocks of one length straight along x at 100 mm/s.
class ProgramPath {
 public:
  explicit ProgramPath(double step_mm) : step_mm_(step_mm) {}

  ProgramPath& step(double step_mm) {
    step_mm_ = step_mm;
    return *this;
  }

  /// To an axis of which x and y are given, about `centre`.
  ProgramPath& to(double x, double y, const Vector3& centre = Vector3::UnitZ()) {
    const Vector3 right = Vector3::UnitY().cross(centre).normalized();
    ClBlock block;
    block.sequence = blocks_.size();
    block.line = 10 + static_cast<std::uint32_t>(blocks_.size());
    block.tip_mm = {x_mm_ += step_mm_, 20, 30};
    block.axis = to_array((centre + x * right + y * centre.cross(right)).normalized());
    block.feed = 100;
    block.feed_meaning = FeedMeaning::kTip;
    blocks_.push_back(block);
    return *this;
  }
  ProgramPath& lean(double azimuth_deg, double tilt_deg) {
    const double azimuth = units::rad_from_deg(azimuth_deg);
    const double size = std::tan(units::rad_from_deg(tilt_deg));
    return to(size * std::cos(azimuth), size * std::sin(azimuth));
  }
  [[nodiscard]] std::vector<ClBlock> program() const {
    auto out = blocks_;
    end_program(out);
    return out;
  }

 private:
  double step_mm_, x_mm_ = 0;
  std::vector<ClBlock> blocks_;
};

/// `count` blocks whose axis wavers within `max_deg` of `centre`.
ProgramPath waver(ProgramPath path, int count, double max_deg,
                  const Vector3& centre = Vector3::UnitZ()) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> share(-1, 1);
  const double largest = units::rad_from_deg(max_deg) / std::sqrt(2.0);
  for (int n = 0; n < count; ++n) {
    const double x = largest * share(engine);
    path.to(x, largest * share(engine), centre);
  }
  return path;
}

/// Plans `blocks`, checks limits, tolerance and that all of them are cut.
SmoothTrace cut(const MachineModel& model, const std::vector<ClBlock>& blocks) {
  const JointVector start = joints_of(model, blocks[0]);
  SmoothTrace trace = plan_smooth(model, blocks, start);
  EXPECT_EQ(trace.last.status, PlanStatus::kOk)
      << "code " << static_cast<int>(trace.last.reject.code) << " block "
      << trace.last.reject.sequence << " by " << trace.last.reject.value;
  if (trace.last.status != PlanStatus::kOk) return trace;
  EXPECT_EQ(trace.times.back().kind, TimeKind::kEnd);
  const auto programmed = programmed_paths(blocks);
  for (const double cycle : {1e-3, 250e-6}) {
    const auto setpoints = sample(model, trace, cycle, 0.37, start);
    const LimitUse use = measure_limits(model, setpoints, cycle);
    EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where << " cycle " << cycle;
    EXPECT_LE(measure_feed(model, trace, setpoints, cycle), 1.0001);
    for (std::size_t n = 3; n + 3 < setpoints.size(); n += 29) {
      const auto k = static_cast<std::size_t>(setpoints[n].piece);
      const bool is_cut =
          trace.times[k].kind == TimeKind::kMove && trace.paths[k].motion != MotionKind::kApproach;
      if (!is_cut || cycle < 1e-3) continue;
      const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
      const double off = distance_from(programmed, trace.times[k].sequence, pose,
                                       model.tolerances.tip_mm, model.tolerances.axis_rad);
      EXPECT_LE(off, kLimit) << "setpoint " << n << " block " << trace.times[k].sequence;
    }
  }
  return trace;
}

TEST(PoleLinger, AWaveringAxisTakesTheTimeThatItTakesAwayFromThePole) {
  const Vector3 away(std::sin(0.3), 0, std::cos(0.3));
  const int blocks = kIsTimed ? 200 : 90;
  for (const MachineModel& model : cases<MachineModel>({bench_machine(), lai_machine()})) {
    for (const double max_deg : cases<double>({0.006, 0.02})) {
      SCOPED_TRACE(testing::Message() << model.name << ", wavers by " << max_deg << " deg");
      const double here_s =
          cut(model, waver(ProgramPath(1), blocks, max_deg).program()).duration_s();
      const double away_s =
          cut(model, waver(ProgramPath(1), blocks, max_deg, away).program()).duration_s();
      std::printf("%s, %d blocks wavering by %.3f deg: %.3f s, away from the pole %.3f s\n",
                  model.name.c_str(), blocks, max_deg, here_s, away_s);
      EXPECT_LT(here_s, 1.05 * away_s);
    }
  }
}

/// Past the pole at `off_deg`, in steps of `step_mm`, 0.5 deg of axis per mm.
std::vector<ClBlock> pass_in_steps(double step_mm, double off_deg) {
  ProgramPath path(step_mm);
  const double off = units::rad_from_deg(off_deg);
  const int steps = static_cast<int>(std::lround(30 / step_mm));
  for (int n = -steps; n <= steps; ++n)
    path.to(std::tan(units::rad_from_deg(0.5 * n * step_mm)), off);
  return path.program();
}

TEST(PoleLinger, ShortBlocksPassThePoleAsFastAsLongOnes) {
  const MachineModel model = bench_machine();
  for (const double off_deg : cases<double>({0.0, 0.005})) {
    const double long_s = cut(model, pass_in_steps(0.1, off_deg)).duration_s();
    const double short_s = cut(model, pass_in_steps(0.02, off_deg)).duration_s();
    std::printf("past the pole at %.3f deg: %.3f s in blocks of 0.1 mm, %.3f s of 0.02 mm\n",
                off_deg, long_s, short_s);
    EXPECT_LT(short_s, 1.02 * long_s);
  }
}

/// Onto the pole from `in_deg`, `count` wavering blocks, off towards `out_deg`.
std::vector<ClBlock> stay(double in_deg, int count, double out_deg) {
  const auto at = [](double azimuth_deg, double tilt_deg) {
    const double azimuth = units::rad_from_deg(azimuth_deg);
    const double size = std::tan(units::rad_from_deg(tilt_deg));
    return std::pair(size * std::cos(azimuth), size * std::sin(azimuth));
  };
  ProgramPath path(1);
  for (int n = 12; n >= 1; --n) {
    const auto [x, y] = at(in_deg, n);
    path.to(x, y);
  }
  path = waver(path, count, 0.01);
  for (int n = 1; n <= 12; ++n) {
    const auto [x, y] = at(out_deg, n);
    path.to(x, y);
  }
  return path.program();
}

TEST(PoleLinger, AWayOntoThePoleAndOffAgainRunsThroughHoweverLongItStays) {
  const MachineModel model = bench_machine();
  for (const int count : cases<int>({2, 20, 300, 70})) {
    for (const double out_deg : cases<double>({0.0, 180.0, 90.0})) {
      SCOPED_TRACE(testing::Message() << count << " blocks, off by " << out_deg << " deg");
      const SmoothTrace trace = cut(model, stay(0, count, out_deg));
      const double feed_s = 0.01 * (23 + count);
      std::printf("%d blocks on the pole, off by %.0f deg: %.3f s, feed %.3f s, %zu relaxed\n",
                  count, out_deg, trace.duration_s(), feed_s, trace.relaxed_axes.size());
      EXPECT_LT(trace.duration_s(), feed_s + (out_deg == 90 ? 2.5 : 1.0));
      for (std::size_t n = 1; n + 1 < trace.times.size(); ++n) {
        const bool is_inside = trace.times[n].sequence > 2 && trace.times[n].sequence < 21U + count;
        EXPECT_FALSE(is_inside && trace.times[n].v == 0)
            << "rest at block " << trace.times[n].sequence;
      }
    }
  }
}

/// A block off the pole and back in a stay on it.
struct Excursion {
  double off_deg, azimuth_deg;
  int after;  ///< so many of the 80 blocks of the stay
};

/// Onto the pole, a stay that wavers by 0.012 deg with an excursion, off on the other side.
std::vector<ClBlock> stay_with(const Excursion& out) {
  ProgramPath path(1);
  for (int n = 12; n >= 0; --n) path.lean(0, n);
  path = waver(path, out.after, 0.012);
  path.lean(out.azimuth_deg, out.off_deg);
  if (out.after == 80) path.lean(0, 0);
  path = waver(path, 80 - out.after, 0.012);
  for (int n = 1; n <= 12; ++n) path.lean(180, n);
  return path.program();
}

TEST(PoleLinger, ABlockOffThePoleAndBackCostsAStayNoTurn) {
  const MachineModel model = bench_machine();
  const double on_s =
      plan_smooth(model, stay_with({0, 0, 0}), joints_of(model, stay_with({0, 0, 0})[0]))
          .duration_s();
  for (const Excursion& out :
       cases<Excursion>({{0.08, 90, 0}, {0.095, 0, 0}, {0.095, 45, 40}, {0.08, 90, 80}})) {
    SCOPED_TRACE(testing::Message() << out.off_deg << " deg off towards " << out.azimuth_deg
                                    << " deg behind " << out.after << " blocks");
    const double time_s = cut(model, stay_with(out)).duration_s();
    std::printf(
        "a block %.3f deg off towards %.0f deg, %d blocks ahead of it: %.3f s, on it %.3f s\n",
        out.off_deg, out.azimuth_deg, out.after, time_s, on_s);
    EXPECT_LT(time_s, 1.05 * on_s);
  }
}

TEST(PoleLinger, AnAxisThatWaversAsFarAsItsToleranceIsHeldAsWell) {
  ProgramPath path(1);
  for (int n = 12; n >= 0; --n) path.lean(0, n);
  path = waver(path, kIsTimed ? 100 : 60, 0.08);
  for (int n = 0; n <= 12; ++n) path.lean(180, n);
  const double time_s = cut(bench_machine(), path.program()).duration_s();
  std::printf("wavers by 0.08 deg under 0.1 deg: %.3f s\n", time_s);
  EXPECT_LT(time_s, 2.5);
}

TEST(PoleLinger, EndsOnThePoleInsideTheLimitsBehindABlockOffIt) {
  ProgramPath path(1);
  for (int n = 12; n >= 0; --n) path.lean(0, n);
  path = waver(path, kIsTimed ? 80 : 45, 0.012);
  path.lean(45, 0.12).lean(0, 0);
  cut(bench_machine(), path.program());
}

/// Seeded: stretches that waver about the pole, as far as three tolerances, that stay on it, and
/// that lead off and back, in steps of 0.0001 to 3 mm.
std::vector<ClBlock> linger(std::uint32_t seed) {
  std::mt19937 engine(seed);
  const auto uniform = [&engine](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  ProgramPath path(1);
  double azimuth = uniform(-3, 3);
  const auto lean = [&](double tilt_deg, double by_mm) {
    const double size = std::tan(units::rad_from_deg(tilt_deg));
    path.step(by_mm).to(size * std::cos(azimuth), size * std::sin(azimuth));
  };
  lean(uniform(0, 1) < 0.3 ? 0.01 : 5, 1);
  for (int section = 0; section < 8; ++section) {
    const double step = std::pow(10.0, uniform(-4, 0.5)),
                 largest = std::pow(10.0, uniform(-3, -0.5));
    const int count = static_cast<int>(uniform(1, 60));
    const int kind = static_cast<int>(uniform(0, 5));
    for (int n = 0; n < count; ++n) {
      if (kind != 1) azimuth += uniform(-1, 1) * (kind == 0 ? 3 : 0.3);
      if (kind == 2) azimuth = std::round(azimuth / 1.5) * 1.5;
      lean(kind == 1 ? 0 : largest * (kind == 3 ? 1 : uniform(0, 1)), step);
    }
    if (uniform(0, 1) < 0.5) continue;
    azimuth += uniform(-2, 2);
    const double farthest = uniform(0.1, 8);
    const int there = static_cast<int>(uniform(1, 12));
    for (int n = 1; n <= there; ++n) lean(farthest * n / there, std::max(step, 0.2));
    if (uniform(0, 1) < 0.5) azimuth += uniform(-0.5, 0.5);
  }
  return path.program();
}

TEST(PoleLinger, KeepsLimitsAndTolerancesHoweverAProgramLingers) {
  const auto programs = number_of("MERIDIAN_LINGER_PROGRAMS", static_cast<unsigned>(draws(6)));
  const auto first = number_of("MERIDIAN_LINGER_SEED", 1U);
  MachineModel endless = lai_machine();
  endless.joints[3].is_endless = true;
  double time_s = 0;
  for (std::uint32_t seed = first; seed < first + programs; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const SmoothTrace trace = cut(seed % 2 == 0 ? bench_machine() : endless, linger(seed));
    time_s += trace.duration_s();
  }
  std::printf("%u programs, %.0f s\n", programs, time_s);
}

/// C has 60 deg either way: towards 90 deg no branch leads off. The machine rests where it is held.
TEST(PoleLinger, WhereNoWayLeadsOffTheFirstBlockThatCannotGoOnIsRefusedByName) {
  MachineModel model = lai_machine();
  model.joints[3].limits.travel_max = units::rad_from_deg(60);
  model.joints[3].limits.travel_min = -model.joints[3].limits.travel_max;
  ProgramPath from_rest = waver(ProgramPath(1), 30, 0.006);
  for (int n = 1; n <= 12; ++n) from_rest.to(0, std::tan(units::rad_from_deg(n)));
  for (const bool is_from_rest : {true, false}) {
    SCOPED_TRACE(is_from_rest ? "begun on the pole" : "come to it");
    const auto blocks = is_from_rest ? from_rest.program() : stay(0, 150, 90);
    const SmoothTrace trace = plan_smooth(model, blocks, joints_of(model, blocks[0]));
    ASSERT_EQ(trace.last.status, PlanStatus::kRefused);
    const BlockReject& reject = trace.last.reject;
    // What it comes to is tried from rest to rest, where C shows to run out of travel.
    EXPECT_EQ(reject.code, is_from_rest ? RejectCode::kBranch : RejectCode::kTravelBetween);
    const auto last = trace.times.empty() ? 0 : trace.times.back().sequence;
    EXPECT_GE(reject.sequence, std::max<std::uint64_t>(1, last));
    EXPECT_LE(reject.sequence, is_from_rest ? 1U : 12U + 150U) << "no motion belongs to it";
    EXPECT_EQ(reject.line, 10 + reject.sequence);
  }
}

/// A program on which some cores are better left where their first excursion begins.
TEST(PoleLinger, TakesExcursionsAlongOnlyWhereThatTakesNoLonger) {
  MachineModel endless = lai_machine();
  endless.joints[3].is_endless = true;
  const auto blocks = linger(64);
  const double time_s = plan_smooth(endless, blocks, joints_of(endless, blocks[0])).duration_s();
  std::printf("seed 64: %.3f s\n", time_s);
  EXPECT_LT(time_s, 9);
}

void expect_same_in_any_chunks(const std::vector<ClBlock>& blocks) {
  const MachineModel model = lai_machine();
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace once = plan_smooth(model, blocks, start);
  for (const std::size_t every : cases<std::size_t>({100000U, 13U})) {
    const SmoothTrace again = plan_smooth(
        model, blocks, start, {Transition::kSmooth, 0, 0},
        [every](std::size_t n) { return n % every == 0; }, [](std::size_t) { return false; });
    EXPECT_TRUE(are_same(once, again)) << "read every " << every << " blocks";
  }
}

TEST(PoleLinger, IsTheSameHoweverTheBlocksArrive) {
  expect_same_in_any_chunks(stay(20, kIsTimed ? 150 : 80, 250));
  expect_same_in_any_chunks(stay_with({0.095, 90, 40}));
}

}  // namespace
}  // namespace meridian::test::pole_linger
