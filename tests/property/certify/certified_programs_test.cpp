// SPDX-License-Identifier: Apache-2.0

/// Seeded programs that look for trouble, planned and certified: the proof has to succeed on every
/// piece of plan, tails included. CI runs a few; more of them, from another seed on:
///
///     MERIDIAN_CERTIFY_PROGRAMS=2000 MERIDIAN_CERTIFY_SEED=1 certify_property_test

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "property/path/hostile_path.hpp"
#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/analysis/certify/certifier.hpp"
#include "service/analysis/certify/plan_tap.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::test::certified_programs {
namespace {

/// What many certificates come to.
struct Certified {
  int programs = 0, refused = 0;
  std::uint64_t pieces = 0, undecided = 0, refuted = 0, broken = 0, stretches = 0;
  double plan_s = 0, tails_s = 0, computing_s = 0;
  std::array<double, certify::kQuantities> bound{}, attained{};
  std::array<double, 3> jump{};

  void take(const certify::Certificate& c) {
    pieces += c.pieces;
    undecided += c.undecided;
    refuted += c.refuted;
    broken += c.broken_joins;
    stretches += c.stretches;
    plan_s += c.plan_s;
    tails_s += c.tails_s;
    computing_s += c.computing_s;
    for (std::size_t n = 0; n < bound.size(); ++n) {
      bound[n] = std::max(bound[n], c.bound[n].share.share);
      attained[n] = std::max(attained[n], c.attained[n].share.share);
    }
    for (std::size_t n = 0; n < jump.size(); ++n)
      jump[n] = std::max(jump[n], c.jump[n].share.share);
  }

  void print(const char* name) const {
    std::printf(
        "%s: %d programs, %d of them refused in part; %llu pieces, %.0f s of motion, %.0f s of "
        "tails, %llu stretches, %.1f s\n  at most v %.6f a %.6f j %.6f feed %.6f, used %.6f %.6f "
        "%.6f %.6f, jumps %.1e %.1e %.1e; %llu undecided, %llu refuted, %llu joins broken\n",
        name, programs, refused, static_cast<unsigned long long>(pieces), plan_s, tails_s,
        static_cast<unsigned long long>(stretches), computing_s, bound[0], bound[1], bound[2],
        bound[3], attained[0], attained[1], attained[2], attained[3], jump[0], jump[1], jump[2],
        static_cast<unsigned long long>(undecided), static_cast<unsigned long long>(refuted),
        static_cast<unsigned long long>(broken));
  }
};

/// Plans `blocks` from `start` and certifies every piece that is published.
certify::Certificate certify_program(const MachineModel& model, const std::vector<ClBlock>& blocks,
                                     const JointVector& start, Transition transition,
                                     bool& is_refused) {
  SmoothPlanner planner(model);
  planner.begin(start, model.tool_length_mm, 0, {transition, 0, 0});
  planner.look_no_further();
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  PatientReader reader(*port);
  certify::PlanTap tap(*port);
  certify::Certifier certifier(model);
  Trace trace;
  const auto read = [&](bool runs_dry) {
    tap.look([&](const TimePiece& piece, const PathPiece* path) { certifier.add(piece, path); });
    reader.read(trace, runs_dry);
    tap.note_dropped();
    trace.times.clear();
    trace.paths.clear();
  };
  for (const ClBlock& block : blocks) {
    PlanResult result;
    for (int tries = 0; tries < 100000; ++tries) {
      result = planner.plan(block, writer);
      read(false);
      if (result.status != PlanStatus::kNoRoom) break;
    }
    is_refused = result.status == PlanStatus::kRefused;
    if (result.status != PlanStatus::kOk) break;
  }
  read(true);
  certifier.finish();
  return certifier.certificate();
}

void expect_certified(const MachineModel& model, const std::vector<ClBlock>& blocks,
                      const JointVector& start, Transition transition, std::uint64_t seed,
                      Certified& all) {
  bool is_refused = false;
  const auto certificate = certify_program(model, blocks, start, transition, is_refused);
  EXPECT_TRUE(certificate.is_given()) << model.name << ", seed " << seed << "\n"
                                      << to_text(certificate, model);
  ++all.programs;
  all.refused += is_refused ? 1 : 0;
  all.take(certificate);
}

/// Another ratio of the limits makes other terms the critical ones.
void draw_limits(RandomPrograms& draw, MachineModel& model) {
  for (int group = 0; group < 2; ++group) {
    const double v = draw.log_uniform(0.3, 3), a = draw.log_uniform(0.2, 20),
                 j = draw.log_uniform(0.1, 30);
    for (int i = group == 0 ? 0 : 3; i < (group == 0 ? 3 : 5); ++i) {
      JointLimits& limits = model.joints[static_cast<std::size_t>(i)].limits;
      limits.velocity *= v;
      limits.acceleration *= a;
      limits.jerk *= j;
    }
  }
}

std::uint64_t first_seed() { return number_of<std::uint64_t>("MERIDIAN_CERTIFY_SEED", 1); }

TEST(CertifiedPrograms, KeepEveryLimitFromRestToRest) {
  Certified all;
  const auto count = number_of<std::uint64_t>("MERIDIAN_CERTIFY_PROGRAMS", draws(40));
  for (std::uint64_t seed = first_seed(); seed < first_seed() + count; ++seed) {
    RandomPrograms draw(seed);
    MachineModel model = seed % 5 == 0   ? hybrid_machine()
                         : seed % 2 == 0 ? bench_machine()
                                         : lai_machine();
    if (draw.chance(0.4)) model.X_MW.rotation = draw.rotation(draw.chance(0.5) ? 0.3 : 3.0);
    if (draw.chance(0.5)) draw_limits(draw, model);
    const JointVector start = draw.start(model);
    expect_certified(model, draw.program(model, 12), start, Transition::kExactStop, seed, all);
  }
  all.print("from rest to rest");
}

TEST(CertifiedPrograms, KeepEveryLimitSmoothly) {
  Certified all;
  const auto count = number_of<std::uint64_t>("MERIDIAN_CERTIFY_PROGRAMS", draws(6));
  for (std::uint64_t seed = first_seed(); seed < first_seed() + count; ++seed) {
    RandomPrograms draw(seed);
    MachineModel model = seed % 5 == 0   ? hybrid_machine()
                         : seed % 2 == 0 ? bench_machine()
                                         : lai_machine();
    if (draw.chance(0.3)) draw_limits(draw, model);
    const auto hostile_seed = static_cast<std::uint32_t>(seed);
    HostilePath path = seed % 3 == 0 ? HostilePath(hostile_seed, 0, units::rad_from_deg(5))
                                     : HostilePath(hostile_seed);
    auto blocks = path.make_program(3);
    const double feed = draw.log_uniform(1, 1000);
    for (ClBlock& block : blocks) block.feed = feed;
    expect_certified(model, blocks, joints_of(model, blocks[0]), Transition::kSmooth, seed, all);
  }
  all.print("smooth");
}

TEST(CertifiedPrograms, KeepEveryLimitSmoothlyOnEveryShippedMachine) {
  Certified all;
  const auto rounds = number_of<std::uint64_t>("MERIDIAN_CERTIFY_PROGRAMS", 0) / 12 + 1;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + rounds; ++seed) {
    for (const std::string& name : shipped_machines()) {
      const MachineModel model = config::load_machine(shipped_file(name).string());
      const auto blocks = HostilePath(static_cast<std::uint32_t>(seed), 0.1, 0.4).make_program(1);
      expect_certified(model, blocks, joints_of(model, blocks[0]), Transition::kSmooth, seed, all);
    }
  }
  all.print("shipped machines");
}

}  // namespace
}  // namespace meridian::test::certified_programs
