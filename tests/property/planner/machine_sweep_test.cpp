// SPDX-License-Identifier: Apache-2.0

/// Seeded programs that look for trouble on every machine file that ships, smooth and from rest to
/// rest: limits, feed, travel, tolerances both ways, the same plan in other chunks, no creeping.
/// CI runs two programs on each machine; more of them, from another seed on:
///
///     MERIDIAN_MACHINE_PROGRAMS=2000 MERIDIAN_MACHINE_SEED=1 machine_sweep_test

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "property/cycle/passed_vertices.hpp"
#include "property/path/hostile_path.hpp"
#include "property/planner/creeping.hpp"
#include "property/planner/drawn_machine.hpp"
#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::test::machine_sweep {
namespace {

constexpr double kLimit = 1 + 1e-6, kFeedLimit = 1.0001, kTravelSlack = 1e-9;
constexpr double kCycle_s = 1e-3;
constexpr int kPrograms = draws(24), kKinds = 4;

struct Sweep {
  LimitUse use;
  double feed = 0, off = 0, missed = 0, creeps_s = 0, seconds = 0;
  int programs = 0;
  std::map<int, std::string> refused;  ///< seeds by RejectCode

  void print(const char* name) const {
    std::printf(
        "%s: %d programs, %.0f s: v %.6f a %.6f j %.6f feed %.6f of the limits, %.4f tolerances, "
        "vertices %.4f, creeps %.3f s more than asked for; refused",
        name, programs, seconds, use.v, use.a, use.j, feed, off, missed, creeps_s);
    for (const auto& [code, seeds] : refused) {
      std::printf("; by code %d those of seeds%s", code, seeds.c_str());
    }
    std::printf("%s\n", refused.empty() ? " none" : "");
  }
};

/// Of four programs one has rapids, arcs, inverse time and steep turns of the axis, one runs about
/// the pole, at 0 to 5 deg.
std::vector<ClBlock> draw_blocks(const MachineModel& model, std::uint32_t seed,
                                 std::uint32_t kind) {
  if (kind == 0) {
    constexpr double kMinFeed_mm_per_s = 0.5;  // slower ones take minutes and show no more
    auto blocks = RandomPrograms(seed).program(model, 12);
    for (ClBlock& block : blocks) {
      if (block.feed_meaning == FeedMeaning::kTip) {
        block.feed = std::max(block.feed, kMinFeed_mm_per_s);
      }
    }
    end_program(blocks);
    return blocks;
  }
  return kind == 1 ? HostilePath(seed, 0, units::rad_from_deg(5)).make_program(4)
                   : HostilePath(seed, 0, 0.5).make_program(4);
}

SmoothTrace plan(const MachineModel& model, const std::vector<ClBlock>& blocks, Transition how,
                 std::size_t blocks_per_read) {
  return plan_smooth(
      model, blocks, joints_of(model, blocks[0]), {how, 0, 0},
      [&](std::size_t n) { return n % blocks_per_read == 0; }, [](std::size_t) { return false; },
      true);
}

/// What blocks in inverse time ask for, which may be as slow as they like.
double asked_s(const std::vector<ClBlock>& blocks) {
  double sum = 0;
  for (const ClBlock& block : blocks) {
    if (block.feed_meaning == FeedMeaning::kInverseTime) sum += 1 / block.feed;
  }
  return sum;
}

bool is_along_program(const PathPiece& path) {
  return path.motion != MotionKind::kApproach && path.motion != MotionKind::kRewind;
}

/// Distances between the way of the tool and the program's, either way, in tolerances.
void check_path(const MachineModel& model, const std::vector<ClBlock>& blocks,
                const SmoothTrace& trace, const std::vector<PlanSample>& setpoints, Sweep& sweep) {
  const auto programmed = programmed_paths(blocks);
  const double tip_mm = model.tolerances.tip_mm, axis_rad = model.tolerances.axis_beside_pole_rad();
  PassedVertices vertices(blocks, tip_mm, axis_rad);
  double off = 0;
  std::size_t before = 0;
  for (std::size_t n = 3; n + 3 < setpoints.size(); ++n) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    if (trace.times[k].kind != TimeKind::kMove || !is_along_program(trace.paths[k])) continue;
    const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
    vertices.add(trace.times[k].sequence, pose, n == before + 1);
    before = n;
    if (n % 7 != 0) continue;
    off = std::max(off,
                   distance_from(programmed, trace.times[k].sequence, pose, tip_mm, axis_rad, off));
  }
  const double missed = vertices.worst(trace.last.status == PlanStatus::kOk);
  EXPECT_LE(off, kLimit);
  EXPECT_LE(missed, kLimit);
  sweep.off = std::max(sweep.off, off);
  sweep.missed = std::max(sweep.missed, missed);
}

void check_limits(const MachineModel& model, const SmoothTrace& trace,
                  const std::vector<PlanSample>& setpoints, Sweep& sweep) {
  const LimitUse use = measure_limits(model, setpoints, kCycle_s);
  EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  const double feed = measure_feed(model, trace, setpoints, kCycle_s);
  EXPECT_LE(feed, kFeedLimit);
  for (const PlanSample& setpoint : setpoints) {
    const int joint = first_joint_outside_travel(model, setpoint.q, kTravelSlack);
    EXPECT_LT(joint, 0) << "at " << (joint < 0 ? 0 : setpoint.q[joint]);
    if (joint >= 0) break;
  }
  sweep.use = {std::max(sweep.use.v, use.v), std::max(sweep.use.a, use.a),
               std::max(sweep.use.j, use.j), ""};
  sweep.feed = std::max(sweep.feed, feed);
}

/// Setpoints of `trace` up to where the machine rests; of a program that is refused the planner is
/// ahead of that.
std::vector<PlanSample> setpoints_of(const MachineModel& model, const SmoothTrace& trace,
                                     const JointVector& start) {
  auto setpoints = sample(model, trace, kCycle_s, 0.37, start);
  JointVector at_rest = setpoints[setpoints.size() - 4].q;
  for (std::size_t n = trace.times.size(); n-- > 0;) {
    const TimePiece& time = trace.times[n];
    if (time.kind != TimeKind::kMove) continue;
    at_rest = joints_at(model, trace.paths[n], state_at(time, time.duration).s, at_rest).q;
    break;
  }
  for (std::size_t n = setpoints.size() - 3; n < setpoints.size(); ++n) setpoints[n].q = at_rest;
  return setpoints;
}

void run_program(const MachineModel& model, std::uint32_t seed, std::uint32_t kind, Transition how,
                 Sweep& sweep) {
  const auto blocks = draw_blocks(model, seed, kind);
  const SmoothTrace trace = plan(model, blocks, how, 1);
  ++sweep.programs;
  if (trace.last.status == PlanStatus::kRefused) {
    sweep.refused[static_cast<int>(trace.last.reject.code)] += " " + std::to_string(seed);
  }
  EXPECT_NE(trace.last.status, PlanStatus::kNoRoom) << "neither planned to its end nor refused";
  EXPECT_TRUE(are_same(trace, plan(model, blocks, how, 7))) << "depends on when blocks are read";
  if (trace.times.empty()) return;
  sweep.seconds += trace.duration_s();
  const double creeps_s = longest_creep_s(model, trace);
  EXPECT_LT(creeps_s, kLongestCreep_s + asked_s(blocks));
  sweep.creeps_s = std::max(sweep.creeps_s, creeps_s - asked_s(blocks));
  const auto setpoints = setpoints_of(model, trace, joints_of(model, blocks[0]));
  check_limits(model, trace, setpoints, sweep);
  check_path(model, blocks, trace, setpoints, sweep);
}

class MachineSweep : public testing::TestWithParam<Transition> {};

TEST_P(MachineSweep, KeepsEveryPromiseOnEveryShippedMachine) {
  const auto first = number_of<std::uint32_t>("MERIDIAN_MACHINE_SEED", 1);
  const auto programs = number_of<std::uint32_t>("MERIDIAN_MACHINE_PROGRAMS", kPrograms);
  std::vector<MachineModel> models;
  std::vector<Sweep> sweeps;
  for (const std::string& name : shipped_machines()) {
    models.push_back(config::load_machine(shipped_file(name)));
  }
  sweeps.resize(models.size());
  for (std::uint32_t seed = first; seed < first + programs; ++seed) {
    const std::size_t which = seed % models.size();
    SCOPED_TRACE(models[which].name + ", seed " + std::to_string(seed));
    const auto kind = static_cast<std::uint32_t>(seed / models.size()) % kKinds;
    run_program(models[which], seed, kind, GetParam(), sweeps[which]);
  }
  for (std::size_t k = 0; k < models.size(); ++k) sweeps[k].print(models[k].name.c_str());
}

/// Turns of 0.06 and 0.2 deg, the one in 0.09 s, the other with tip feed, ahead of turns of 67 and
/// 100 s: they took 37 and 34 s while a span was as slow as the slowest block on it.
TEST(MachineSeed, TakesAShortTurnAheadOfASlowOneInItsTime) {
  Sweep sweep;
  run_program(config::load_machine(shipped_file("bench")), 970032, 0, Transition::kSmooth, sweep);
  run_program(config::load_machine(shipped_file("fork-cb")), 971042, 0, Transition::kSmooth, sweep);
}

/// Two corners of the axis 0.08 mm apart, on a stretch of 61 mm: the second was off by 1.006
/// tolerances where the sharpest of every 0.24 mm alone was checked.
TEST(MachineSeed, KeepsTheToleranceAtEveryCornerOfTheAxisBesideThePole) {
  Sweep sweep;
  run_program(config::load_machine(shipped_file("head-table-bc")), 972063, 1, Transition::kSmooth,
              sweep);
}

/// Programs that circle fast about the pole just ahead of it: bench comes onto the pole, fork-ca
/// begins there.
TEST(MachineSeed, RunsThroughThePoleBehindFastCircles) {
  struct Drawn {
    const char* machine;
    std::uint32_t seed, kind;
  };
  for (const Drawn& drawn : {Drawn{"bench", 910380, 1}, Drawn{"fork-ca", 911761, 0}}) {
    SCOPED_TRACE(std::string(drawn.machine) + ", seed " + std::to_string(drawn.seed));
    Sweep sweep;
    run_program(config::load_machine(shipped_file(drawn.machine)), drawn.seed, drawn.kind,
                Transition::kSmooth, sweep);
    EXPECT_TRUE(sweep.refused.empty());
  }
}

TEST_P(MachineSweep, KeepsEveryPromiseOnMachinesThatNobodyShipped) {
  const auto first = number_of<std::uint32_t>("MERIDIAN_MACHINE_SEED", 1);
  const auto programs = number_of<std::uint32_t>("MERIDIAN_MACHINE_PROGRAMS", kPrograms);
  Sweep sweep;
  int no_machines = 0;
  for (std::uint32_t seed = first; seed < first + programs; ++seed) {
    SCOPED_TRACE("drawn machine " + std::to_string(seed));
    if (const auto model = drawn_machine(seed)) {
      run_program(*model, seed, seed % kKinds, GetParam(), sweep);
    } else {
      ++no_machines;
    }
  }
  sweep.print("drawn");
  EXPECT_LE(10 * no_machines, programs + 10) << "refused by the loader";
}

INSTANTIATE_TEST_SUITE_P(Every, MachineSweep,
                         testing::Values(Transition::kSmooth, Transition::kExactStop),
                         [](const testing::TestParamInfo<Transition>& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::test::machine_sweep
