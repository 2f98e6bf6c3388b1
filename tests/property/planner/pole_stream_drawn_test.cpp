// SPDX-License-Identifier: Apache-2.0

/// Drawn programs that visit the pole, streamed in any manner: MERIDIAN_POLE_STREAMS of them, from
/// seed MERIDIAN_POLE_STREAM_SEED on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "property/planner/block_stream.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/cpu_time.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_stream_drawn {
namespace {

int seeds() { return number_of("MERIDIAN_POLE_STREAMS", draws(1)); }
int first_seed() { return number_of("MERIDIAN_POLE_STREAM_SEED", 11); }

struct Drawn {
  MachineModel model;
  std::vector<ClBlock> blocks;
  JointVector start{};
  Transition transition = Transition::kSmooth;
};

Drawn draw(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const auto whole = [&](int a, int b) { return std::uniform_int_distribution<int>(a, b)(random); };
  Drawn out;
  out.transition = whole(0, 3) == 0 ? Transition::kExactStop : Transition::kSmooth;
  const bool is_fork = whole(0, 1) == 0;
  out.model = is_fork ? limited(fork_machine(), -200, 200) : bench_machine();
  if (!is_fork && whole(0, 1) == 0) out.model = limited(bench_machine(), -200, 200);
  const double tolerance =
      std::max(out.model.tolerances.pole_axis_rad, out.model.tolerances.axis_rad);
  double x = 0;
  Vector3 lean(units::rad_from_deg(-8), 0, 0);  // as a place in the plane of small axes
  const auto put = [&](const Vector3& at, double step) {
    x += step;
    out.blocks.push_back(leaning(at.norm(), std::atan2(at.y(), at.x()), Vector3(x, 0, 0)));
  };
  const auto go_to = [&](const Vector3& to, int count, double step) {
    const Vector3 begin = lean;
    for (int n = 1; n <= count; ++n) put(begin + (to - begin) * (1.0 * n / count), step);
    lean = to;
  };
  put(lean, 1);
  const int ahead = whole(0, 2) == 0 ? whole(2100, 2300) : whole(0, 300);
  for (int n = 0; n < ahead; ++n) put(lean, n % 40 < 20 ? 1 : -1);
  const int visits = whole(1, 3);
  for (int visit = 0; visit < visits; ++visit) {
    go_to({real(-1.5, 1.5) * tolerance, real(-1.5, 1.5) * tolerance, 0}, whole(10, 60), 1);
    const int lingers = whole(0, 1) == 0 ? 0 : whole(1, 12);
    const double size = real(0.05, 3);
    for (int n = 0; n < lingers; ++n) {
      go_to({real(-size, size) * tolerance, real(-size, size) * tolerance, 0}, whole(1, 20),
            real(0.1, 1.5));
    }
    const double azimuth = real(-3.2, 3.2), by = units::rad_from_deg(real(2, 9));
    go_to({by * std::cos(azimuth), by * std::sin(azimuth), 0}, whole(20, 80), 1);
    if (whole(0, 1) == 0) {  // round it
      const double turn = real(-5, 5);
      const int count = 2 + static_cast<int>(std::abs(turn) * 20);
      for (int n = 1; n <= count; ++n) {
        const double angle = azimuth + turn * n / count;
        put({by * std::cos(angle), by * std::sin(angle), 0}, 1);
      }
      lean = {by * std::cos(azimuth + turn), by * std::sin(azimuth + turn), 0};
    }
  }
  go_to(lean * (units::rad_from_deg(12) / lean.norm()), 60, 1);
  const int after = whole(0, 2) == 0 ? whole(1900, 2600) : whole(0, 300);
  for (int n = 0; n < after; ++n) put(lean, n % 40 < 20 ? 1 : -1);
  number_and_end(out.blocks);
  const int branch = whole(0, 1);
  out.start = solve_block(out.model, out.blocks[0], branch);
  JointLimits& limits = out.model.joints[4].limits;
  if (whole(0, 3) > 0) {
    const double side = out.start[4] > 0 ? 1 : -1;
    const double other = units::rad_from_deg(real(1, 11));
    limits.travel_min = side > 0 ? -other : units::rad_from_deg(-60);
    limits.travel_max = side > 0 ? units::rad_from_deg(60) : other;
  }
  return out;
}

struct Played : StreamOutcome {
  double excess_s = 0, excess_took_s = 0;  ///< of a call over a quarter of what it published
  std::size_t excess_at = 0;
  std::vector<std::size_t> stalls;
};

enum class Reported { kNothing, kStalls, kFinish };

/// Blocks of `drawn`, the first `count` or all, in a manner drawn from `manner`; `marks`: of a run
/// that is replayed.
Played run(const Drawn& drawn, int manner, Reported reported,
           const std::vector<FeedMark>* marks = nullptr, std::size_t count = 0) {
  Played out;
  std::mt19937 random(static_cast<unsigned>(manner));
  const auto whole = [&](int a, int b) { return std::uniform_int_distribution<int>(a, b)(random); };
  BlockStream stream(drawn.model, drawn.start, drawn.transition, marks);
  SmoothPlanner& planner = stream.planner;
  MotionWriter& writer = stream.writer;
  const int every = manner == 0 ? 1 : whole(1, 400);
  const auto timed = [&](std::size_t n, const auto& call) {
    const double before = cpu_s();
    const double published_s = writer.published_s();
    call();
    const double took = cpu_s() - before;
    const double gain_s = writer.published_s() - published_s;
    if (n > SmoothPlanner::kLookAhead && took - 0.25 * gain_s > out.excess_s) {
      out.excess_s = took - 0.25 * gain_s;
      out.excess_at = n;
      out.excess_took_s = took;
    }
  };
  if (count == 0) count = drawn.blocks.size();
  for (std::size_t n = 0; n < count; ++n) {
    if (reported == Reported::kStalls && n > 1 && planner.look() > 0 && whole(0, 30) == 0) {
      if (whole(0, 3) > 0) (void)planner.advance(writer);  // as planner_thread does
      for (int k = 0; k < 5 && planner.look() > 0; ++k) {
        out.stalls.push_back(n);
        stream.stall();
        stream.read();
      }
    }
    if (!stream.offer(drawn.blocks[n], false, [&](const auto& call) { timed(n, call); })) break;
    if (manner != 0 && whole(0, 5) == 0) timed(n, [&] { (void)planner.advance(writer); });
    if (n % static_cast<std::size_t>(every) == 0) stream.read();
  }
  if (reported == Reported::kFinish) {
    planner.finish();
    for (int n = 0; n < 50; ++n) {
      (void)planner.advance(writer);
      stream.read();
    }
  }
  static_cast<StreamOutcome&>(out) = stream.end();
  return out;
}

TEST(PoleStreamDrawn, IsTheSameHoweverTheBlocksArriveAndNeverStuck) {
  const int from = first_seed(), count = seeds();
  double excess = 0;
  int refused = 0;
  for (int seed = from; seed < from + count; ++seed) {
    const Drawn drawn = draw(seed);
    const Played one = run(drawn, 0, Reported::kNothing);
    refused += one.trace.last.status == PlanStatus::kRefused;
    if (one.excess_s > excess) {
      excess = one.excess_s;
      std::printf("seed %d: %.1f ms at block %zu of %zu, %.1f over a quarter of its motion\n", seed,
                  1e3 * one.excess_took_s, one.excess_at, drawn.blocks.size(), 1e3 * excess);
    }
    EXPECT_EQ(one.stuck_at, 0U) << "stuck, seed " << seed << " exact stop "
                                << (drawn.transition == Transition::kExactStop);
    for (int manner = 1; manner <= 3; ++manner) {
      const Played other = run(drawn, 100 * seed + manner, Reported::kNothing);
      EXPECT_TRUE(are_same(one.trace, other.trace))
          << "differs, seed " << seed << " manner " << manner << " stuck at " << other.stuck_at;
    }
  }
  std::printf("refused %d of %d\n", refused, count);
}

/// Seed 12 is the first of which a stall changes the plan: a replay that lost its marks shows
/// there.
TEST(PoleStreamDrawn, ReplaysStalls) {
  const int from = number_of("MERIDIAN_POLE_STREAM_SEED", 12), count = seeds();
  int late = 0, changed = 0;
  for (int seed = from; seed < from + count; ++seed) {
    const Drawn drawn = draw(seed);
    const Played undisturbed = run(drawn, 0, Reported::kNothing);
    for (int manner = 1; manner <= 3; ++manner) {
      const Played stalled = run(drawn, 100 * seed + manner, Reported::kStalls);
      if (stalled.stalls.empty()) continue;
      ++late;
      changed += !are_same(stalled.trace, undisturbed.trace);
      const Played replayed = run(drawn, 0, Reported::kNothing, &stalled.marks);
      std::string reported;
      for (const FeedMark& mark : stalled.marks) {
        if (mark.looked_at > 0)
          reported +=
              " {" + std::to_string(mark.sequence) + "," + std::to_string(mark.looked_at) + "}";
      }
      EXPECT_TRUE(are_same(stalled.trace, replayed.trace))
          << "differs, seed " << seed << " manner " << manner << " exact stop "
          << (drawn.transition == Transition::kExactStop) << reported << " stuck "
          << stalled.stuck_at << "/" << replayed.stuck_at << " rewinds "
          << stalled.trace.rewinds.size();
    }
  }
  std::printf("stalled %d, of which %d changed the plan\n", late, changed);
  EXPECT_GT(late, 0) << "nothing was replayed";
  EXPECT_GT(changed, 0) << "no stall changed a plan: a replay without marks would be the same";
}

/// A station that is gone: what ran before is that of the whole program, or it is told why not.
TEST(PoleStreamDrawn, ReplaysWhatRanBeforeAStationWasGone) {
  const int from = first_seed(), count = seeds();
  int compared = 0;  // pieces of zones
  for (int seed = from; seed < from + count; ++seed) {
    const Drawn drawn = draw(seed);
    std::mt19937 random(static_cast<unsigned>(seed));
    for (int manner = 1; manner <= 3; ++manner) {
      const std::size_t until = 10 + random() % (drawn.blocks.size() - 11);
      const Played cut = run(drawn, 0, Reported::kFinish, nullptr, until);
      const Played replayed = run(drawn, 0, Reported::kNothing, &cut.marks);
      // Zones are compared: what the redundant joint does past the pole.
      std::size_t n = 0, m = 0;
      bool is_same = true;
      std::uint64_t where = 0;
      const auto next = [](const SmoothTrace& trace, std::size_t& k) {
        while (k < trace.paths.size() && !trace.paths[k].is_free_driven) ++k;
        return k < trace.paths.size();
      };
      for (; is_same && next(cut.trace, n) && next(replayed.trace, m); ++n, ++m) {
        // What a run that ends there rounds otherwise is passed another way.
        constexpr std::uint64_t kOfTheEnd = 220;  // blocks of 1 mm
        if (cut.trace.paths[n].sequence + kOfTheEnd > until) break;
        const PathPiece &a = cut.trace.paths[n], &b = replayed.trace.paths[m];
        is_same = a.branch == b.branch && std::abs(a.joints_end[4] - b.joints_end[4]) < 0.1;
        where = a.sequence;
        ++compared;
      }
      EXPECT_TRUE(is_same) << "seed " << seed << " until " << until << " at block " << where
                           << " exact stop " << (drawn.transition == Transition::kExactStop);
    }
  }
  std::printf("compared %d\n", compared);
  EXPECT_GT(compared, 0) << "nothing was compared";
}

}  // namespace
}  // namespace meridian::test::pole_stream_drawn
