// SPDX-License-Identifier: Apache-2.0

/// The authority that smooth plans grant to stops: at any instant, at any rate of plan time, no
/// hold and no FaultStop exceeds its limits, and most stop in nearly the least time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <vector>

#include "meridian/cycle/rate_filter.hpp"
#include "meridian/cycle/stop/stop_margin.hpp"
#include "property/cycle/stop_oracle.hpp"
#include "property/path/hostile_path.hpp"
#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::smooth_stop {
namespace {

constexpr double kLimit = 1 + 1e-6;

constexpr int kPrograms = draws(6);

std::vector<ClBlock> hostile(std::uint32_t seed) {
  auto blocks = HostilePath(seed).make_program(6);
  for (ClBlock& block : blocks) block.feed = std::max(block.feed, 20.0);
  return blocks;
}

/// A machine on a plan: the time piece, the plan time since its begin, and the rate of plan time.
struct OnPlan {
  std::size_t piece = 0;
  double time = 0, rate = 1, slope = 0;

  [[nodiscard]] PathState state(const Trace& trace) const {
    const PathState p = state_at(trace.times[piece], time);
    return {p.s, p.ds * rate, p.dds * rate * rate + p.ds * slope, 0};
  }
};

bool is_move(const Trace& trace, std::size_t n) {
  return n < trace.times.size() && trace.times[n].kind == TimeKind::kMove;
}

/// Goes along the plan as the cycle does, its rate falling, until there is authority for a stop.
/// The time that it takes.
double wait_for_authority(const Trace& trace, StopKind kind, OnPlan& at, StopMargin& authority) {
  constexpr double kCycle_s = 1e-3;
  RateFilter rate;
  double waited = 0;
  authority = authority_of(trace.times[at.piece], kind, at.state(trace));
  if (authority.jerk > 0) return 0;
  rate.reset(at.rate);
  rate.aim(0);
  while (!(authority.jerk > 0)) {
    waited += kCycle_s;
    at.time += rate.advance(kCycle_s);
    at.rate = rate.rate();
    at.slope = rate.slope();
    while (is_move(trace, at.piece) && at.time >= trace.times[at.piece].duration) {
      at.time -= trace.times[at.piece++].duration;
    }
    if (!is_move(trace, at.piece) || rate.is_settled()) break;
    authority = authority_of(trace.times[at.piece], kind, at.state(trace));
  }
  return waited;
}

/// The paths of a trace from one time piece on, in one path length that counts from the begin of
/// the first.
class PathsAhead {
 public:
  PathsAhead(const Trace& trace, std::size_t piece)
      : trace_(trace), piece_(piece), reference_(trace.paths[piece].joints_begin) {}

  /// The joints at `s`, no less than the last. False: the plan ends before.
  template <class Scalar>
  bool try_joints(const MachineModel& model, double s, Joints<Scalar>& q) {
    bool is_on_path = true;
    while (s - passed_ > path().length + 1e-12) {
      std::size_t next = piece_;
      while (is_move(trace_, next) && trace_.paths[next].index == path().index) ++next;
      if (!is_move(trace_, next) || rests_before(next)) {
        is_on_path = s - passed_ <= path().length + 1e-6;
        break;
      }
      passed_ += path().length;
      piece_ = next;
    }
    const double x = std::clamp(s - passed_, 0.0, path().length);
    if constexpr (std::is_same_v<Scalar, double>) {
      q = joints_at(model, path(), x, reference_).q;
    } else {
      q = joints_at(model, path(), Scalar::variable(x), reference_).q;
    }
    for (int i = 0; i < model.joint_count; ++i) reference_[i] = value_of(q[i]);
    return is_on_path;
  }

 private:
  [[nodiscard]] const PathPiece& path() const { return trace_.paths[piece_]; }
  [[nodiscard]] bool rests_before(std::size_t next) const {
    const TimePiece& time = trace_.times[next];
    return time.is_from_rest && time.window != trace_.times[next - 1].window;
  }

  const Trace& trace_;
  std::size_t piece_;
  double passed_ = 0;
  JointVector reference_;
};

/// Largest share of the limits that a stop along `law` from time piece `piece` uses, by derivatives
/// of the joints on the path; 99 where it passes the end of the plan.
double use_of(const MachineModel& model, const Trace& trace, std::size_t piece, const StopLaw& law,
              StopKind kind) {
  double use = 0;
  PathsAhead ahead(trace, piece);
  const int steps = std::max(8, static_cast<int>(law.duration() / 4e-4));
  for (int n = 0; n <= steps; ++n) {
    const PathState p = law.at(law.duration() * n / steps * (1 - 1e-12));
    Joints<Jet<3>> q;
    if (!ahead.try_joints(model, p.s, q)) return 99;
    for (int i = 0; i < model.joint_count; ++i) {
      const double d1 = q[i].derivative(1), d2 = q[i].derivative(2), d3 = q[i].derivative(3);
      const JointLimits& limits = model.joints[i].limits;
      const bool is_fault = kind == StopKind::kFault;
      const double accel = is_fault ? limits.fault_acceleration : limits.acceleration;
      const double jerk = is_fault ? limits.fault_jerk : limits.jerk;
      const double bend = d3 * p.ds * p.ds * p.ds + 3 * d2 * p.ds * p.dds;
      use = std::max({use, std::abs(d1 * p.ds) / limits.velocity,
                      std::abs(d1 * p.dds + d2 * p.ds * p.ds) / accel,
                      std::abs(d1 * p.ddds + bend) / jerk});
    }
  }
  return use;
}

/// Setpoints of a hold that begins with `law` in time piece `piece`.
std::vector<PlanSample> hold_setpoints(const MachineModel& model, const Trace& trace,
                                       std::size_t piece, const StopLaw& law, double cycle_s) {
  std::vector<PlanSample> out;
  PathsAhead ahead(trace, piece);
  for (int n = 0; n * cycle_s < law.duration(); ++n) {
    PlanSample setpoint{{}, static_cast<int>(piece), law.at(n * cycle_s).s};
    EXPECT_TRUE(ahead.try_joints(model, setpoint.s, setpoint.q));
    out.push_back(setpoint);
  }
  return out;
}

/// The machine with its FaultStop limits for limits.
MachineModel by_fault_limits(MachineModel model) {
  for (JointSpec& joint : model.joints) {
    joint.limits.acceleration = joint.limits.fault_acceleration;
    joint.limits.jerk = joint.limits.fault_jerk;
  }
  return model;
}

/// Any instant and any rate of plan time that the rate filter can give.
OnPlan draw_state(RandomPrograms& random, const Trace& trace, std::size_t piece) {
  OnPlan at;
  at.piece = piece;
  at.time = random.uniform(0, trace.times[piece].duration);
  if (random.chance(0.6)) return at;
  at.rate = random.uniform(0.05, 1);
  const double steepest = std::min(1.0, std::sqrt(20 * (1 - at.rate)));
  if (random.chance(0.5))
    at.slope = random.uniform(-std::min(1.0, std::sqrt(20 * at.rate)), steepest);
  return at;
}

struct Stops {
  int count = 0, over = 0, shortened = 0, taken_over = 0;
  double worst = 0, longest_wait = 0;
  std::vector<double> ratios;  ///< time over the least time

  void print(const char* what) {
    std::sort(ratios.begin(), ratios.end());
    const auto share = [&](double x) { return ratios[static_cast<std::size_t>(x * (count - 1))]; };
    const auto slow = ratios.end() - std::upper_bound(ratios.begin(), ratios.end(), 1.25);
    std::printf(
        "%d %s, %d laid out anew, %d over a limit, worst %.4f; (time - 2 cycles)/least: median "
        "%.3f, 90 %% %.3f, "
        "%.1f %% above 1.25; longest way along the plan %.3f s\n",
        count, what, shortened, over, worst, share(0.5), share(0.9),
        100.0 * static_cast<double>(slow) / count, longest_wait);
  }
};

/// A FaultStop that takes a hold over where the machine is in `here` keeps its limits.
void check_fault_stop(const MachineModel& model, const Trace& trace, std::size_t piece,
                      const PathState& here, const PathState& plan, Stops& stops) {
  const StopMargin margin = authority_on_law(trace.times[piece], StopKind::kFault, here, plan);
  if (!(margin.jerk > 0)) return;
  const double use = use_of(model, trace, piece, StopLaw(here, margin), StopKind::kFault);
  stops.over += use > kLimit;
  ++stops.taken_over;
}

/// Goes on with `law` from where the machine is, cycle by cycle, and lays it out anew as the cycle
/// does where the piece that it has come to grants more. The time to rest.
double follow_law(const MachineModel& model, const Trace& trace, std::size_t piece, StopLaw law,
                  StopKind kind, Stops& stops) {
  constexpr double kCycle_s = 1e-3;
  double passed = 0, time = 0, since = 0, plan_time = 0;
  int cycles = 0;
  while (law.duration() - since > kCycle_s) {
    time += kCycle_s;
    since += kCycle_s;
    PathState here = law.at(since);
    here.s -= passed;
    while (here.s > state_at(trace.times[piece], trace.times[piece].duration).s) {
      if (!is_move(trace, piece + 1)) return time;
      const PathPiece& path = trace.paths[piece++];
      plan_time = 0;
      if (trace.paths[piece].index == path.index) continue;
      here.s -= path.length;
      passed += path.length;
    }
    const TimePiece& now = trace.times[piece];
    plan_time = time_at(now, here.s, plan_time);
    const PathState plan = state_at(now, plan_time);
    if (kind == StopKind::kHold && ++cycles % 16 == 5) {
      check_fault_stop(model, trace, piece, here, plan, stops);
    }
    const StopMargin margin = authority_on_law(now, kind, here, plan);
    if (!(margin.jerk > 0)) continue;
    const StopLaw shorter(here, margin);
    if (!(shorter.duration() < law.duration() - since - kCycle_s)) continue;
    const double use = use_of(model, trace, piece, shorter, kind);
    stops.over += use > kLimit;
    stops.worst = std::max(stops.worst, use);
    ++stops.shortened;
    law = shorter;
    since = passed = 0;
  }
  return time + law.duration() - since;
}

void stop_from(const MachineModel& model, const Trace& trace, OnPlan at, StopKind kind,
               Stops& stops) {
  const PathState begin = at.state(trace);
  if (begin.ds <= 1e-3) return;
  const double smallest =
      min_stopping_time(kind == StopKind::kFault ? by_fault_limits(model) : model,
                        trace.paths[at.piece], begin, trace.paths[at.piece].joints_begin);
  StopMargin authority;
  double time = wait_for_authority(trace, kind, at, authority);
  stops.longest_wait = std::max(stops.longest_wait, time);
  if (authority.jerk > 0) {
    const StopLaw law(at.state(trace), authority);
    const double use = use_of(model, trace, at.piece, law, kind);
    stops.over += use > kLimit;
    stops.worst = std::max(stops.worst, use);
    time += follow_law(model, trace, at.piece, law, kind, stops);
  }
  ++stops.count;
  stops.ratios.push_back(std::max(0.0, time - 2e-3) / smallest);
}

/// Stops drawn on what the feed planner plans of hostile programs.
void expect_stops_inside_limits(Transition transition) {
  const int first = number_of("MERIDIAN_STOP_SEED", 1);
  const int programs = number_of("MERIDIAN_STOP_PROGRAMS", kPrograms);
  Stops holds, faults;
  for (int seed = first; seed < first + programs; ++seed) {
    RandomPrograms random(static_cast<std::uint64_t>(seed));
    MachineModel model = seed % 2 == 0 ? bench_machine() : lai_machine();
    const auto blocks = hostile(static_cast<std::uint32_t>(seed));
    const auto trace = plan_smooth(model, blocks, joints_of(model, blocks[0]), {transition});
    ASSERT_EQ(trace.last.status, PlanStatus::kOk) << "seed " << seed;
    for (std::size_t n = 0; n < trace.times.size(); ++n) {
      if (!is_move(trace, n) || !is_by_feed_planner(trace.times[n])) continue;
      if (!random.chance(0.1)) continue;
      stop_from(model, trace, draw_state(random, trace, n), StopKind::kHold, holds);
      stop_from(model, trace, draw_state(random, trace, n), StopKind::kFault, faults);
    }
  }
  holds.print("holds");
  faults.print("FaultStops");
  EXPECT_GT(holds.count, draws(100));
  EXPECT_GT(holds.shortened, draws(20));
  EXPECT_GT(holds.taken_over, draws(100));
  EXPECT_EQ(holds.over, 0);
  EXPECT_EQ(faults.over, 0);
  EXPECT_LT(holds.longest_wait, 0.5);
  EXPECT_LT(holds.ratios[holds.ratios.size() / 2], 1.05);
  EXPECT_LT(faults.ratios[faults.ratios.size() * 3 / 4], 1.1);
}

/// A longer run: MERIDIAN_STOP_SEED=100 MERIDIAN_STOP_PROGRAMS=200
/// build/release/bin/smooth_property_test --gtest_filter='SmoothStop*'
TEST(SmoothStop, KeepsItsLimitsFromAnyInstantAtAnyRate) {
  expect_stops_inside_limits(Transition::kSmooth);
}

TEST(SmoothStop, KeepsItsLimitsOnLegsFromRestToRest) {
  expect_stops_inside_limits(Transition::kExactStop);
}

ClBlock cut_to(const Vector3& tip, const Vector3& axis, double feed_mm_per_s) {
  ClBlock block;
  block.kind = BlockKind::kCut;
  block.tip_mm = to_array(tip);
  block.axis = to_array(axis);
  block.feed = feed_mm_per_s;
  block.feed_meaning = FeedMeaning::kTip;
  return block;
}

TEST(SmoothStop, KeepsTheVelocityLimitWhereItBeginsWhileTheSpeedGrows) {
  MachineModel model = bench_machine();
  model.override_ramp_s = 1000;  // so the plan rises to the limit with all the jerk that there is
  const Vector3 up(0, 0, 1);
  std::vector<ClBlock> blocks;
  for (const double x : {0.0, 200.0}) blocks.push_back(cut_to({x, 0, 20}, up, 1000));
  number_and_end(blocks);
  const auto trace = plan_smooth(model, blocks, joints_of(model, blocks[0]));
  ASSERT_EQ(trace.last.status, PlanStatus::kOk);
  Stops holds;
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    if (!is_move(trace, n) || trace.paths[n].kind != PathKind::kSpline) continue;
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
      const OnPlan at{n, share * trace.times[n].duration, 1, 0};
      if (at.state(trace).dds > 0) stop_from(model, trace, at, StopKind::kHold, holds);
    }
  }
  holds.print("holds");
  EXPECT_GT(holds.count, 100);
  EXPECT_EQ(holds.over, 0);
}

TEST(SmoothStop, LeavesRoomForRoundingBesideThePole) {
  // 8 µrad to 0.006° beside it, where C is made of the last digits of the axis.
  constexpr std::uint64_t kSeed = 4711;
  constexpr double kCycle_s = 125e-6;
  constexpr int kPaths = 16;
  RandomPrograms draw(kSeed);
  double largest = 0;
  int holds = 0;
  for (int n = 0; n < kPaths; ++n) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << " path " << n);
    MachineModel model = lai_machine();
    model.cycle_ns = 125'000;
    model.override_ramp_s = 1000;
    model.pole_policy = PolePolicy::kExact;
    model.X_MW.rotation = draw.rotation(1.0);
    const double distance = draw.log_uniform(8.2e-6, 1e-4), azimuth = draw.uniform(-3, 3);
    const auto beside = [&](double along) {
      const Vector3 axis = Vector3(std::sin(along), distance, std::cos(along)).normalized();
      const double c = std::cos(azimuth), s = std::sin(azimuth);
      const Vector3 turned(c * axis[0] - s * axis[1], s * axis[0] + c * axis[1], axis[2]);
      return Vector3(model.X_MW.rotation.transpose() * turned);
    };
    const Vector3 at(draw.uniform(-150, 150), draw.uniform(-150, 150), 20);
    std::vector<ClBlock> blocks;
    for (int k = 0; k <= 8; ++k) {
      blocks.push_back(cut_to(at + Vector3(3, 1, 0) * k, beside(0.01 * (k - 4)), 50));
    }
    number_and_end(blocks);
    const SmoothSettings settings{Transition::kSmooth, 1e-3, 1e-6};
    const auto trace = plan_smooth(model, blocks, joints_of(model, blocks[0]), settings);
    ASSERT_EQ(trace.last.status, PlanStatus::kOk);
    for (std::size_t k = 0; k < trace.times.size(); ++k) {
      if (!is_move(trace, k) || trace.paths[k].kind != PathKind::kSpline) continue;
      const OnPlan from{k, draw.uniform(0, trace.times[k].duration), 1, 0};
      const StopMargin authority = authority_of(trace.times[k], StopKind::kHold, from.state(trace));
      if (!(authority.jerk > 0)) continue;
      const StopLaw law(from.state(trace), authority);
      const auto setpoints = hold_setpoints(model, trace, k, law, kCycle_s);
      const LimitUse use = measure_limits(model, setpoints, kCycle_s);
      largest = std::max({largest, use.v, use.a, use.j});
      ++holds;
    }
  }
  std::printf("%d holds, largest use of a limit %.5f\n", holds, largest);
  EXPECT_GT(holds, 1000);
  EXPECT_LE(largest, kLimit);
}

}  // namespace
}  // namespace meridian::test::smooth_stop
