// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "property/planner/singular_passes.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/shipped_machines.hpp"

/// Robots pass their singular places, smooth and in exact stop: every joint inside its limits, the
/// tool inside its tolerance, no creeping; refused is what leaves travel.
namespace meridian::test {
namespace {

constexpr double kShare = 1 + 1e-6;  // of a limit or a tolerance, with what rounding adds
constexpr double kLongest_s = 60;    // the longest program takes 3 s at its feed, and 61 rests

enum class Where { kWrist, kShoulder, kBoth };

struct Sweep {
  const char* name;
  const char* machine;
  Where where;
  Transition transition;

  [[nodiscard]] std::unique_ptr<SingularPass> draw(const MachineModel& robot,
                                                   std::uint32_t seed) const {
    if (where == Where::kWrist) return std::make_unique<WristPass>(robot, seed);
    if (where == Where::kBoth) return std::make_unique<BothPass>(robot, seed);
    return std::make_unique<ShoulderPass>(robot, seed);
  }
  /// Distances to pass at: degrees or mm, at both degrees and mm; the last is what times are
  /// compared with.
  [[nodiscard]] std::vector<double> beside() const {
    if (where == Where::kWrist) return {0, 1e-9, 1e-7, 1e-5, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.5, 1, 5};
    return {0, 1e-9, 1e-6, 1e-4, 1e-3, 5e-3, 9e-3, 0.012, 0.03, 0.1, 1, 5};
  }
};

class SingularSweep : public testing::TestWithParam<Sweep> {};

/// Without the approach.
double cutting_time_s(const Trace& trace) {
  double sum = 0;
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    if (trace.paths[n].motion != MotionKind::kApproach) sum += trace.times[n].duration;
  }
  return sum;
}

/// In tolerances.
double farthest_off(const MachineModel& model, const std::vector<ClBlock>& blocks,
                    const Trace& trace, const std::vector<PlanSample>& setpoints) {
  const auto ways = programmed_paths(blocks);
  double farthest = 0;
  for (std::size_t n = 3; n + 3 < setpoints.size(); n += 7) {
    const auto piece = static_cast<std::size_t>(setpoints[n].piece);
    if (trace.paths[piece].motion == MotionKind::kApproach) continue;
    const ToolPose pose = forward(model, model.tool_length_mm, setpoints[n].q);
    farthest =
        std::max(farthest, distance_from(ways, trace.times[piece].sequence, pose,
                                         model.tolerances.tip_mm, model.tolerances.axis_rad, 1.0));
  }
  return farthest;
}

TEST_P(SingularSweep, KeepsLimitsAndToleranceAndNeverCreeps) {
  const Sweep& sweep = GetParam();
  const auto first = number_of<std::uint32_t>("MERIDIAN_SINGULAR_SEED", 1);
  const auto draws = number_of<std::uint32_t>("MERIDIAN_SINGULAR_PASSES", 1);
  MachineModel robot = config::load_machine(shipped_file(sweep.machine));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  const std::vector<double> beside = sweep.beside();
  const bool is_verbose = number_of<int>("MERIDIAN_SINGULAR_VERBOSE", 0) != 0;
  int planned = 0;
  std::map<std::string, int> refused;
  double slowest = 0;
  for (std::uint32_t seed = first; seed < first + draws; ++seed) {
    const auto singular = sweep.draw(robot, seed);
    for (const Pass pass : kPasses) {
      double time_beside = 0;
      for (std::size_t k = beside.size(); k-- > 0;) {
        const bool is_in_short_run = k % 4 == 3 || k == 0;  // farthest, closest and between
        if (draws == 1 && !is_in_short_run) continue;
        SCOPED_TRACE(testing::Message()
                     << "seed " << seed << " " << kPassNames[static_cast<int>(pass)] << " beside "
                     << beside[k]);
        const double by = sweep.where == Where::kWrist ? units::rad_from_deg(beside[k]) : beside[k];
        const auto blocks = singular->program(pass, by);
        const JointVector start = joints_of(robot, blocks[0]);
        SmoothTrace trace = plan_smooth(robot, blocks, start, {sweep.transition, 0, 0}, true);
        trace.joints = end_of(robot, trace, start);
        const auto setpoints = sample(robot, trace, 1e-3, 0.5, start);
        const LimitUse use = measure_limits(robot, setpoints, 1e-3);
        EXPECT_LT(std::max({use.v, use.a, use.j}), kShare) << use.where;
        EXPECT_LT(farthest_off(robot, blocks, trace, setpoints), kShare);
        const double time_s = cutting_time_s(trace);
        EXPECT_LT(time_s, kLongest_s);
        ++planned;
        if (is_verbose) {
          std::printf("  seed %u %s beside %g: %.3f s\n", seed, kPassNames[static_cast<int>(pass)],
                      beside[k], time_s);
        }
        if (trace.last.status == PlanStatus::kRefused) {
          const BlockReject& reject = trace.last.reject;
          const bool leaves_travel =
              reject.code == RejectCode::kTravelBetween || reject.code == RejectCode::kTravel;
          // A start beside the very place: no pass is inside travel, and the exact way jumps.
          const bool starts_there = pass == Pass::kOff && k + 6 < beside.size();
          EXPECT_TRUE(leaves_travel || (starts_there && reject.code == RejectCode::kDiscontinuous))
              << "code " << static_cast<int>(reject.code) << " line " << reject.line;
          ++refused[std::string(kPassNames[static_cast<int>(pass)]) + ", " +
                    (reject.joint >= 0 ? "joint " + std::to_string(reject.joint) : "no joint") +
                    ", code " + std::to_string(static_cast<int>(reject.code))];
          if (is_verbose) {
            std::printf("  seed %u %s beside %g: joint %d at %.3f, code %d, line %u\n", seed,
                        kPassNames[static_cast<int>(pass)], beside[k], reject.joint, reject.value,
                        static_cast<int>(reject.code), reject.line);
          }
          continue;
        }
        if (k + 1 == beside.size()) time_beside = time_s;
        if (time_beside > 0) slowest = std::max(slowest, time_s / time_beside);
      }
    }
  }
  std::printf("%d passes, the slowest takes %.2f of the time at the farthest\n", planned, slowest);
  for (const auto& [reason, count] : refused)
    std::printf("  %d refused: %s\n", count, reason.c_str());
}

struct DrawnPass {
  std::uint32_t seed;
  Pass pass;
  double beside;  // mm, at both places degrees as well
  Transition transition;
};

/// Runs to its end, inside limits and tolerances.
template <class Drawn>
void expect_passed(const DrawnPass& drawn) {
  SCOPED_TRACE(testing::Message() << "seed " << drawn.seed << " "
                                  << kPassNames[static_cast<int>(drawn.pass)] << " beside "
                                  << drawn.beside);
  MachineModel robot = config::load_machine(shipped_file("robot-6r"));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  const auto blocks = Drawn(robot, drawn.seed).program(drawn.pass, drawn.beside);
  const JointVector start = joints_of(robot, blocks[0]);
  SmoothTrace trace = plan_smooth(robot, blocks, start, {drawn.transition, 0, 0}, true);
  EXPECT_EQ(trace.last.status, PlanStatus::kOk);
  trace.joints = end_of(robot, trace, start);
  const auto setpoints = sample(robot, trace, 1e-3, 0.5, start);
  const LimitUse use = measure_limits(robot, setpoints, 1e-3);
  EXPECT_LT(std::max({use.v, use.a, use.j}), kShare) << use.where;
  EXPECT_LT(farthest_off(robot, blocks, trace, setpoints), kShare);
  EXPECT_LT(trace.duration_s(), kLongest_s) << "it creeps";
}

/// Passes along the base axis, closely beside it, on which the roll runs out of travel with the yaw
/// at rest. They were refused: behind them the exact yaw would have jumped.
TEST(SingularSeed, AlongTheBaseAxisTheYawTurnsWhereTheRollRunsOutOfTravel) {
  for (const DrawnPass& drawn : {
           DrawnPass{1016, Pass::kAlong, 1e-3, Transition::kSmooth},
           DrawnPass{1016, Pass::kAlong, 1e-6, Transition::kExactStop},
           DrawnPass{1016, Pass::kAlong, 1e-9, Transition::kExactStop},
           DrawnPass{1022, Pass::kAlong, 1e-6, Transition::kExactStop},
           DrawnPass{1022, Pass::kAlong, 1e-9, Transition::kExactStop},
           DrawnPass{1045, Pass::kAlong, 1e-9, Transition::kExactStop},
       }) {
    expect_passed<ShoulderPass>(drawn);
  }
}

/// Programs that start over the base axis, or with the wrist in line, and lead off.
TEST(SingularSeed, YawAndRollFirstTurnAtRestWhereAProgramStartsInBothPlaces) {
  for (const DrawnPass& drawn : {
           DrawnPass{3012, Pass::kOff, 0.1, Transition::kSmooth},
           DrawnPass{3012, Pass::kOff, 9e-3, Transition::kSmooth},
           DrawnPass{3006, Pass::kOff, 1e-4, Transition::kSmooth},
           DrawnPass{5005, Pass::kOff, 9e-3, Transition::kSmooth},
       }) {
    expect_passed<BothPass>(drawn);
  }
}

/// A block that ends beside its point, by nearly the tolerance: the next one's passes keep the
/// tolerance to the point, and lead on from where the machine stands.
TEST(SingularSeed, InExactStopPassesOfBothPlacesKeepTheToleranceFromBlockToBlock) {
  for (const DrawnPass& drawn : {
           DrawnPass{2001, Pass::kThrough, 9e-3, Transition::kExactStop},
           DrawnPass{2002, Pass::kThrough, 9e-3, Transition::kExactStop},
           DrawnPass{2004, Pass::kThrough, 9e-3, Transition::kExactStop},
           DrawnPass{5001, Pass::kAlong, 9e-3, Transition::kExactStop},
       }) {
    expect_passed<BothPass>(drawn);
  }
}

TEST(SingularSeed, BothPlacesArePassedStraightThroughBesideOneOfThem) {
  expect_passed<BothPass>({3001, Pass::kThrough, 5e-3, Transition::kSmooth});
  expect_passed<BothPass>({3005, Pass::kAlong, 0, Transition::kSmooth});
}

INSTANTIATE_TEST_SUITE_P(
    Of, SingularSweep,
    testing::Values(
        Sweep{"WristSmooth", "robot-6r", Where::kWrist, Transition::kSmooth},
        Sweep{"WristExactStop", "robot-6r", Where::kWrist, Transition::kExactStop},
        Sweep{"ShoulderSmooth", "robot-6r", Where::kShoulder, Transition::kSmooth},
        Sweep{"ShoulderExactStop", "robot-6r", Where::kShoulder, Transition::kExactStop},
        Sweep{"BothSmooth", "robot-6r", Where::kBoth, Transition::kSmooth},
        Sweep{"BothExactStop", "robot-6r", Where::kBoth, Transition::kExactStop},
        Sweep{"ShoulderOf5RSmooth", "robot-5r", Where::kShoulder, Transition::kSmooth},
        Sweep{"ShoulderOf5RExactStop", "robot-5r", Where::kShoulder, Transition::kExactStop}),
    [](const testing::TestParamInfo<Sweep>& sweep) { return sweep.param.name; });

}  // namespace
}  // namespace meridian::test
