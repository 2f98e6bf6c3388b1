// SPDX-License-Identifier: Apache-2.0

/// Holds at any instant of smooth programs, in the cycle: how long they take and how far they go,
/// against the hardest braking that the joints' limits allow at each point, and against a stop that
/// keeps them on the path ahead. A longer run on other seeds:
///
///     MERIDIAN_HOLD_SEED=1000 MERIDIAN_HOLD_PROGRAMS=300 rt_motion_test
///     --gtest_filter='SmoothHold*'

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "property/cycle/attainable_stop.hpp"
#include "property/cycle/program_run.hpp"
#include "property/cycle/stop_oracle.hpp"
#include "property/path/hostile_path.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/host/probe/budgets.hpp"
#include "support/draws.hpp"

namespace meridian::test::smooth_hold {
namespace {

using SmoothRunning = PlannedRun<SmoothPlanner>;

constexpr int kPrograms = draws(12);
constexpr double kMaxSeconds = 15;  // of motion per program

std::vector<ClBlock> hostile(std::uint32_t seed) {
  auto blocks = HostilePath(seed).make_program(6);
  for (ClBlock& block : blocks) block.feed = std::max(block.feed, 20.0);
  return blocks;
}

/// The path of a plan from one of its pieces on: joints at path lengths that grow, counted from the
/// begin of that piece.
class PathAhead {
 public:
  PathAhead(const MachineModel& model, const Trace& trace, std::size_t piece,
            const JointVector& joints)
      : model_(model), trace_(trace), piece_(piece), reference_(joints) {}

  /// Where the path piece ends that joints were asked for last.
  [[nodiscard]] double end() const { return passed_ + path().length; }

  [[nodiscard]] Joints<Jet<3>> operator()(double s) {
    while (s - passed_ > path().length) {
      std::size_t next = piece_;
      while (is_move(next) && trace_.paths[next].index == path().index) ++next;
      if (!is_move(next)) break;
      passed_ += path().length;
      piece_ = next;
    }
    const double here = std::min(s - passed_, path().length);
    const auto q = joints_at(model_, path(), Jet<3>::variable(here), reference_).q;
    for (std::size_t i = 0; i < q.size(); ++i) reference_[i] = value_of(q[i]);
    return q;
  }

 private:
  [[nodiscard]] const PathPiece& path() const { return trace_.paths[piece_]; }
  [[nodiscard]] bool is_move(std::size_t n) const {
    return n < trace_.times.size() && trace_.times[n].kind == TimeKind::kMove;
  }

  const MachineModel& model_;
  const Trace& trace_;
  std::size_t piece_;
  JointVector reference_;
  double passed_ = 0;
};

/// Where the cycle is in a plan that was read piece by piece; the trace's size where it is not.
std::size_t find_piece(const Trace& trace, const TimePiece& wanted) {
  const auto is_it = [&](const TimePiece& piece) {
    return piece.window == wanted.window && piece.path_index == wanted.path_index &&
           piece.s0 == wanted.s0 && piece.is_tail == wanted.is_tail;
  };
  return static_cast<std::size_t>(std::find_if(trace.times.begin(), trace.times.end(), is_it) -
                                  trace.times.begin());
}

/// What holds came to; the cycles that the budget of a stop grants are taken off, and the way at
/// the first speed in them.
struct Holds {
  const probe::Budget stop = probe::load_budget("stop_time");  ///< in cycles
  std::vector<double> time, distance;                          ///< over the least
  std::vector<double> late_s, far_mm;                          ///< beyond its factor of the least

  std::vector<double> attainable, gap;  ///< time over the attainable one, that over the least
  int late_along_plan = 0;              ///< later than the factor of it, without a law at first
  int cut_short = 0;                    ///< programs whose plan became another one on the way
  int unknown = 0;                      ///< no attainable stop was found: the least counts for it

  void take(double time_s, double distance_mm, const MinStop& min) {
    time.push_back(time_s / min.time_s);
    distance.push_back(distance_mm / min.distance_mm);
    late_s.push_back(time_s - stop.factor * min.time_s);
    far_mm.push_back(distance_mm - stop.factor * min.distance_mm);
  }
  void take(double time_s, const MinStop& min, const std::optional<StopMotion>& found,
            bool is_along_plan) {
    if (!found) ++unknown;
    const double attainable_s = found ? found->time_s() : min.time_s;
    attainable.push_back(time_s / attainable_s);
    gap.push_back(attainable_s / min.time_s);
    if (is_along_plan && attainable.back() > stop.factor) ++late_along_plan;
  }
  void sort() {
    for (auto* all : {&time, &distance, &late_s, &far_mm, &attainable, &gap})
      std::sort(all->begin(), all->end());
  }
  /// How many exceed `bound`, in percent.
  [[nodiscard]] static double percent_above(const std::vector<double>& all, double bound) {
    const auto above = std::count_if(all.begin(), all.end(), [=](double x) { return x > bound; });
    return 100.0 * static_cast<double>(above) / static_cast<double>(all.size());
  }
  /// The value that a share of them does not exceed.
  [[nodiscard]] static double at(const std::vector<double>& all, double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  }
};

void print(const char* what, const std::vector<double>& all) {
  std::printf("  %-34s median %.3f, 75 %% %.3f, 90 %% %.3f, 99 %% %.3f, worst %.3f\n", what,
              Holds::at(all, 0.5), Holds::at(all, 0.75), Holds::at(all, 0.9), Holds::at(all, 0.99),
              all.back());
}

void expect_kept(const std::string& name, double figure, double reference = 0) {
  const probe::Budget budget = probe::load_budget(name);
  EXPECT_TRUE(budget.is_kept(figure, reference)) << figure << "; " << to_text(budget, reference);
}

void hold_at_any_instant(std::uint32_t seed, Holds& holds) {
  RandomPrograms random(seed);
  MachineModel machine = seed % 2 == 0 ? bench_machine() : lai_machine();
  machine.transition = Transition::kSmooth;
  const auto blocks = hostile(seed);
  const JointVector start = joints_of(machine, blocks[0]);
  const auto trace = plan_smooth(machine, blocks, start);
  SmoothRunning run(machine, blocks, start);
  ASSERT_TRUE(run.is_started());
  const double dt = run.world.dt();
  double next = random.uniform(0, 0.2);
  for (double t = 0; t < kMaxSeconds && !run.is_over(); t += dt) {
    if (t < next || !is_on_path(run.world.now()) || run.world.reader.path() == nullptr) {
      run.run();
      continue;
    }
    next = t + random.log_uniform(0.02, 3);  // a resume takes a second to come back to full rate
    const PathState begin = run.world.state.on_path;
    const bool is_smooth = run.world.reader.path()->kind == PathKind::kSpline;
    const std::size_t piece = find_piece(trace, *run.world.reader.piece());
    const JointVector joints = run.world.state.joints;
    run.command(Verb::kHold);
    const bool is_along = is_along_plan(run.world.state.stop.mode);
    for (double s = 0; s < 10 && run.world.now() != State::kHeld; s += dt) run.run();
    ASSERT_EQ(run.world.now(), State::kHeld);
    const Event stopped = run.world.last(EventCode::kStopped);
    run.command(Verb::kResume);
    if (piece == trace.times.size()) {  // a hold kept a tail: behind it the plan is another one
      ASSERT_TRUE(run.writer().tail_entered());
      ++holds.cut_short;
      return;
    }
    if (!is_smooth || begin.ds <= 1e-3) continue;
    const PathAhead ahead(machine, trace, piece, joints);
    const MinStop min = min_stop(machine, begin, PathAhead(ahead));
    const double granted_s = holds.stop.plus * dt;
    const double taken_s = static_cast<double>(stopped.a) * 1e-9 - granted_s;
    holds.take(taken_s, stopped.x - granted_s * begin.ds, min);
    holds.take(taken_s, min, AttainableStop(machine, begin, ahead).find(), is_along);
  }
}

TEST(SmoothHold, StopsInLittleMoreThanTheLeastTimeAndLength) {
  const std::uint32_t first = number_of("MERIDIAN_HOLD_SEED", 1);
  const std::uint32_t programs =
      number_of("MERIDIAN_HOLD_PROGRAMS", static_cast<std::uint32_t>(kPrograms));
  Holds holds;
  for (std::uint32_t seed = first; seed < first + programs; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    hold_at_any_instant(seed, holds);
  }
  ASSERT_GT(holds.time.size(), 10U);
  holds.sort();
  const double late_percent = Holds::percent_above(holds.late_s, 0);
  const double late_attainable = Holds::percent_above(holds.attainable, holds.stop.factor);
  std::printf("%zu holds, %.1f %% later than %.2f of the least time\n", holds.time.size(),
              late_percent, holds.stop.factor);
  std::printf(
      "  %.1f %% later than that of the attainable time: %d along the plan first, %.0f not\n",
      late_attainable, holds.late_along_plan,
      late_attainable / 100 * static_cast<double>(holds.time.size()) - holds.late_along_plan);
  if (holds.unknown > 0) std::printf("  %d without an attainable stop\n", holds.unknown);
  EXPECT_LE(holds.cut_short, 1 + programs / 20) << "programs that a hold made another plan of";
  print("time over the attainable one", holds.attainable);
  print("attainable time over the least", holds.gap);
  print("time over the least", holds.time);
  print("length over the least", holds.distance);
  print("later than the budget of a stop, s", holds.late_s);
  print("farther than its factor, mm", holds.far_mm);
  expect_kept("smooth_stop_late_by", holds.late_s.back());
  expect_kept("smooth_stop_far_by", holds.far_mm.back());
  if (holds.time.size() < 100) return;  // a sanitizer's few draws have no shares
  expect_kept("smooth_stop_late", late_percent);
  expect_kept("smooth_stop_late_attainable", late_attainable);
  expect_kept("smooth_stop_time_p75", Holds::at(holds.time, 0.75), 1);
  expect_kept("smooth_stop_length_p75", Holds::at(holds.distance, 0.75), 1);
}

/// One of its holds begins on a rise of the plan while a resume still raises the rate. A law that
/// let go of both there took C over its velocity, and the guard ended the program.
TEST(SmoothHold, KeepsTheVelocityLimitWhereItBeginsWhileTheRateStillRises) {
  constexpr std::uint32_t kSeed = 1194;
  Holds holds;
  hold_at_any_instant(kSeed, holds);
  EXPECT_GT(holds.time.size(), 5U);
}

}  // namespace
}  // namespace meridian::test::smooth_hold
