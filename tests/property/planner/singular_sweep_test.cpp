// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <sstream>
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

enum class At { kWrist, kShoulder, kBoth };

struct Sweep {
  const char* name;
  const char* machine;
  At at;
  Transition transition;

  [[nodiscard]] std::unique_ptr<SingularPass> draw(const MachineModel& robot,
                                                   std::uint32_t seed) const {
    if (at == At::kWrist) return std::make_unique<WristPass>(robot, seed);
    if (at == At::kShoulder) return std::make_unique<ShoulderPass>(robot, seed);
    return std::make_unique<BothPass>(robot, seed);
  }
  /// Distances to pass at: degrees, mm or tolerances; the last is what times are compared with.
  [[nodiscard]] std::vector<double> beside() const {
    if (at == At::kBoth) return {0, 1e-8, 1e-6, 1e-4, 0.01, 0.1, 0.5, 0.9, 1.2, 3, 10, 50};
    if (at == At::kWrist) return {0, 1e-9, 1e-7, 1e-5, 1e-3, 0.01, 0.05, 0.09, 0.1, 0.2, 0.5, 1, 5};
    return {0, 1e-9, 1e-6, 1e-4, 1e-3, 5e-3, 7e-3, 9e-3, 0.012, 0.03, 0.1, 1, 5};
  }
};

/// A start at one of the first of them is beside the very place.
constexpr std::size_t kStartsBeside = 6;

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
  const auto programmed = programmed_paths(blocks);
  double farthest = 0;
  for (std::size_t n = 3; n + 3 < setpoints.size(); n += 7) {
    const auto piece = static_cast<std::size_t>(setpoints[n].piece);
    if (trace.paths[piece].motion == MotionKind::kApproach) continue;
    const ToolPose pose = forward(model, model.tool_length_mm, setpoints[n].q);
    farthest =
        std::max(farthest, distance_from(programmed, trace.times[piece].sequence, pose,
                                         model.tolerances.tip_mm, model.tolerances.axis_rad, 1.0));
  }
  return farthest;
}

/// What a program comes to.
struct Outcome {
  SmoothTrace trace;
  LimitUse use;
  double off = 0;     ///< in tolerances
  double time_s = 0;  ///< of the cuts
};

Outcome planned(const MachineModel& robot, const std::vector<ClBlock>& blocks,
                Transition transition) {
  Outcome out;
  const JointVector start = joints_of(robot, blocks[0]);
  out.trace = plan_smooth(robot, blocks, start, {transition, 0, 0}, true);
  out.trace.joints = end_of(robot, out.trace, start);
  const auto setpoints = sample(robot, out.trace, 1e-3, 0.5, start);
  out.use = measure_limits(robot, setpoints, 1e-3);
  out.off = farthest_off(robot, blocks, out.trace, setpoints);
  out.time_s = cutting_time_s(out.trace);
  EXPECT_LT(std::max({out.use.v, out.use.a, out.use.j}), kShare) << out.use.where;
  EXPECT_LT(out.off, kShare);
  EXPECT_LT(out.time_s, kLongest_s) << "it creeps";
  return out;
}

/// Why a program was refused, by pass, joint and code.
using Refusals = std::map<std::string, int>;

void note_refusal(const BlockReject& reject, Pass pass, bool starts_beside, Refusals& refused) {
  const bool leaves_travel =
      reject.code == RejectCode::kTravelBetween || reject.code == RejectCode::kTravel;
  // A start beside the very place: no pass is inside travel, and the exact way jumps.
  EXPECT_TRUE(leaves_travel || (starts_beside && reject.code == RejectCode::kDiscontinuous))
      << "code " << static_cast<int>(reject.code) << " line " << reject.line;
  ++refused[std::string(kPassNames[static_cast<int>(pass)]) + ", " +
            (reject.joint >= 0 ? "joint " + std::to_string(reject.joint) : "no joint") + ", code " +
            std::to_string(static_cast<int>(reject.code))];
}

TEST_P(SingularSweep, KeepsLimitsAndToleranceAndNeverCreeps) {
  const Sweep& sweep = GetParam();
  const auto first = number_of<std::uint32_t>("MERIDIAN_SINGULAR_SEED", 1);
  const auto draws = number_of<std::uint32_t>("MERIDIAN_SINGULAR_PASSES", 1);
  MachineModel robot = config::load_machine(shipped_file(sweep.machine));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  const std::vector<double> beside = sweep.beside();
  // Of the distances: closest, between, inside the tolerance by a tenth, on or behind it, farthest.
  const auto short_run = cases<std::size_t>({0, 3, 7, 8, beside.size() - 1});
  const bool is_verbose = number_of<int>("MERIDIAN_SINGULAR_VERBOSE", 0) != 0;
  int passes = 0;
  Refusals refused;
  double slowest = 0, farthest = 0;
  for (std::uint32_t seed = first; seed < first + draws; ++seed) {
    const auto singular = sweep.draw(robot, seed);
    for (const Pass pass : kPasses) {
      double time_beside = 0;
      for (std::size_t k = beside.size(); k-- > 0;) {
        const bool is_in_short_run =
            std::find(short_run.begin(), short_run.end(), k) != short_run.end();
        if (draws == 1 && !is_in_short_run) continue;
        const std::string name = "seed " + std::to_string(seed) + " " +
                                 kPassNames[static_cast<int>(pass)] + " beside " +
                                 (std::ostringstream() << beside[k]).str();
        SCOPED_TRACE(name);
        const double by = sweep.at == At::kWrist ? units::rad_from_deg(beside[k]) : beside[k];
        const Outcome out = planned(robot, singular->program(pass, by), sweep.transition);
        ++passes;
        farthest = std::max(farthest, out.off);
        const BlockReject& reject = out.trace.last.reject;
        const bool is_refused = out.trace.last.status == PlanStatus::kRefused;
        if (is_verbose) {
          std::printf("  %s: %.3f s, %.3f off", name.c_str(), out.time_s, out.off);
          if (is_refused) {
            std::printf(", joint %d at %.3f, code %d, line %u", reject.joint, reject.value,
                        static_cast<int>(reject.code), reject.line);
          }
          std::printf("\n");
        }
        if (is_refused) {
          note_refusal(reject, pass, pass == Pass::kOff && k < kStartsBeside, refused);
          continue;
        }
        if (k + 1 == beside.size()) time_beside = out.time_s;
        if (time_beside > 0) slowest = std::max(slowest, out.time_s / time_beside);
      }
    }
  }
  std::printf(
      "%d passes, the slowest takes %.2f of the time at the farthest, %.3f tolerances off\n",
      passes, slowest, farthest);
  for (const auto& [reason, count] : refused)
    std::printf("  %d refused: %s\n", count, reason.c_str());
}

/// Passes that were refused once, or left the tolerance.
class SingularSeed : public testing::Test {
 protected:
  SingularSeed() : robot_(config::load_machine(shipped_file("robot-6r"))) {
    config::place_workpiece(robot_, config::parse_frame("0,0,0"));
  }
  void expect_planned(const std::vector<ClBlock>& blocks, Transition transition) const {
    EXPECT_EQ(planned(robot_, blocks, transition).trace.last.status, PlanStatus::kOk);
  }

  MachineModel robot_;
};

/// Closely beside the base axis the roll runs out of travel with the yaw at rest. Such passes were
/// refused: behind them the exact yaw would have jumped.
TEST_F(SingularSeed, AlongTheBaseAxisTheYawTurnsWhereTheRollRunsOutOfTravel) {
  struct Along {
    std::uint32_t seed;
    double beside_mm;
    Transition transition;
  };
  for (const auto& [seed, beside_mm, transition] : {
           Along{1016, 1e-3, Transition::kSmooth},
           Along{1016, 1e-6, Transition::kExactStop},
           Along{1016, 1e-9, Transition::kExactStop},
           Along{1022, 9e-3, Transition::kExactStop},
           Along{1022, 5e-3, Transition::kExactStop},
           Along{1022, 1e-6, Transition::kExactStop},
           Along{1022, 1e-9, Transition::kExactStop},
           Along{1045, 1e-9, Transition::kExactStop},
       }) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " beside " << beside_mm);
    expect_planned(ShoulderPass(robot_, seed).program(Pass::kAlong, beside_mm), transition);
  }
}

/// A dwell after every cut.
std::vector<ClBlock> with_dwells(const std::vector<ClBlock>& blocks) {
  std::vector<ClBlock> out;
  for (const ClBlock& block : blocks) {
    if (block.kind != BlockKind::kCut) continue;
    out.push_back(block);
    out.push_back({.line = block.line, .kind = BlockKind::kDwell});
  }
  number_and_end(out);
  return out;
}

/// Through the base axis a block ends inside the tolerance by a tenth, at rest. A yaw that rested
/// there anyhow once led the next block out of the tolerance: rests added up.
TEST_F(SingularSeed, RestsBesideTheBaseAxisDoNotAddUp) {
  for (const std::uint32_t seed : {11, 12}) {
    SCOPED_TRACE(seed);
    const auto blocks = ShoulderPass(robot_, seed).program(Pass::kThrough, 9e-3);
    (void)planned(robot_, blocks, Transition::kExactStop);
    (void)planned(robot_, with_dwells(blocks), Transition::kExactStop);
  }
}

/// Onto both, 0.9 of the tolerance beside: the yaw had to turn by 90 degrees in the last 0.01 mm.
TEST_F(SingularSeed, OntoBothTheJointsRestInsideTheTolerance) {
  expect_planned(BothPass(robot_, 8).program(Pass::kOnto, 0.9), Transition::kExactStop);
}

/// Off the wrist's singular place windows found no plan where the roll comes to rest, and stopped.
TEST_F(SingularSeed, OffTheWristThePlanGoesOnWhereTheRollComesToRest) {
  const Outcome out =
      planned(robot_, WristPass(robot_, 1).program(Pass::kOff, 0), Transition::kSmooth);
  EXPECT_EQ(out.trace.last.status, PlanStatus::kOk);
  EXPECT_LT(out.time_s, 1.6);
}

INSTANTIATE_TEST_SUITE_P(
    Of, SingularSweep,
    testing::Values(Sweep{"WristSmooth", "robot-6r", At::kWrist, Transition::kSmooth},
                    Sweep{"WristExactStop", "robot-6r", At::kWrist, Transition::kExactStop},
                    Sweep{"ShoulderSmooth", "robot-6r", At::kShoulder, Transition::kSmooth},
                    Sweep{"ShoulderExactStop", "robot-6r", At::kShoulder, Transition::kExactStop},
                    Sweep{"ShoulderOf5RSmooth", "robot-5r", At::kShoulder, Transition::kSmooth},
                    Sweep{"ShoulderOf5RExactStop", "robot-5r", At::kShoulder,
                          Transition::kExactStop},
                    Sweep{"BothSmooth", "robot-6r", At::kBoth, Transition::kSmooth},
                    Sweep{"BothExactStop", "robot-6r", At::kBoth, Transition::kExactStop}),
    [](const testing::TestParamInfo<Sweep>& sweep) { return sweep.param.name; });

}  // namespace
}  // namespace meridian::test
