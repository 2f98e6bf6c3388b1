// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/stop/stop_margin_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "meridian/cycle/stop/stop_law.hpp"
#include "meridian/planner/time_law.hpp"

namespace meridian::test::stop_margin_table {
namespace {

/// Limits of one joint: 100 mm/s, 1000 mm/s², 20000 mm/s³ planned, twice and thrice of the last two
/// in a FaultStop.
JointCaps caps(double accel = 1, double jerk = 1) {
  JointCaps out;
  out.count = 1;
  out.velocity[0] = 100;
  out.acceleration[0] = 1000 * accel;
  out.jerk[0] = 20000 * jerk;
  return out;
}

/// `count` cells of 1 mm from `offset` on, where the joint goes rate(n) times as fast as the path.
template <class Rate>
std::vector<JointCell> cells_of(int count, double offset, const Rate& rate) {
  std::vector<JointCell> out(static_cast<std::size_t>(count));
  for (int n = 0; n < count; ++n) {
    out[n].begin = offset + n;
    out[n].end = offset + n + 1;
    out[n].d1[0] = rate(n);
  }
  return out;
}

/// A motion over `length` and what stops may use on the way.
struct Granted {
  std::vector<JointCell> cells;
  JointCaps hold = caps(), fault = caps(2, 3);
  MotionChoice choice;
  std::vector<TimePiece> times;
  std::vector<double> cuts;

  Granted(std::vector<JointCell> made, double offset, double length) : cells(std::move(made)) {
    choice = choose_motion(cells, hold, length, 1e9);
    const StopMarginTable table(cells, offset, hold, fault, choice);
    const ProfilePhases phases = phases_of(choice.profile, length);
    for (int n = 0; n < phases.count; ++n) {
      const ProfilePhase& phase = phases.phase[n];
      const auto found = table.cut(phase);
      for (int k = 0; k <= found.count; ++k) {
        const double t = k == 0 ? 0 : found.time[k - 1];
        if (k > 0) cuts.push_back(t);
        TimePiece time;
        time.duration = (k == found.count ? phase.duration : found.time[k]) - t;
        EXPECT_GT(time.duration, 0);
        time.s0 = phase.s + t * (phase.v + t * (phase.a / 2 + t * phase.j / 6));
        time.v = phase.v + t * (phase.a + t * phase.j / 2);
        time.a = phase.a + t * phase.j;
        time.j = phase.j;
        table.grant(time);
        times.push_back(time);
      }
    }
  }

  /// The largest shares of acceleration and jerk that stops from all times use in the cells that
  /// they pass.
  [[nodiscard]] JointCaps use(bool is_fault, double offset) const {
    JointCaps largest;
    const JointCaps& limits = is_fault ? fault : hold;
    for (const TimePiece& time : times) {
      const StopMargin margin = is_fault ? StopMargin{time.fault_accel, time.fault_jerk}
                                         : StopMargin{time.stop_accel, time.stop_jerk};
      for (int k = 0; k <= 4; ++k) {
        const StopLaw law(state_at(time, k * time.duration / 4), margin);
        for (int n = 0; n < 40; ++n) {
          const PathState at = law.at(n * law.duration() / 40);
          const auto cell = std::min(cells.size() - 1, static_cast<std::size_t>(at.s));
          EXPECT_LE(cells[cell].begin - offset, at.s + 1e-9);
          const double rate = cells[cell].d1[0];
          largest.acceleration[0] =
              std::max(largest.acceleration[0], rate * std::abs(at.dds) / limits.acceleration[0]);
          largest.jerk[0] = std::max(largest.jerk[0], rate * std::abs(at.ddds) / limits.jerk[0]);
        }
      }
    }
    return largest;
  }
};

TEST(StopMarginTable, LetsAStopUseAllThatTheJointHasWhereThePathIsEven) {
  const Granted even(cells_of(20, 0, [](int) { return 2; }), 0, 20);
  EXPECT_TRUE(even.cuts.empty());
  ASSERT_GE(even.times.size(), 5U);
  const TimePiece& cruise = even.times[even.times.size() / 2];
  // ṡ is up to 50: a deceleration of sqrt(J v) is all that a stop reaches.
  EXPECT_NEAR(cruise.stop_jerk, 10000, 1e-6);
  EXPECT_NEAR(cruise.stop_accel, std::min(500.0, 1.01 * std::sqrt(10000 * cruise.v)), 1);
  EXPECT_NEAR(cruise.fault_jerk, 30000, 1e-6);
  EXPECT_NEAR(cruise.fault_accel, std::min(1000.0, 1.01 * std::sqrt(30000 * cruise.v)), 1);
  EXPECT_EQ(cruise.rest_stop_accel, 500);
  EXPECT_EQ(cruise.rest_stop_jerk, 10000);
  EXPECT_EQ(cruise.rest_fault_accel, 1000);
  EXPECT_EQ(cruise.rest_fault_jerk, 30000);
  EXPECT_NEAR(cruise.authority_velocity, cruise.v, 1e-9);
}

TEST(StopMarginTable, GrantsAtLeastWhatTheMotionItselfUses) {
  const Granted even(cells_of(20, 0, [](int) { return 2; }), 0, 20);
  for (const TimePiece& time : even.times) {
    EXPECT_GE(time.stop_jerk, even.choice.profile.jerk);
    EXPECT_GE(time.stop_accel, even.choice.profile.peak_acceleration());
    EXPECT_GE(time.fault_accel, time.stop_accel);
    EXPECT_GE(time.fault_jerk, time.stop_jerk);
  }
}

/// Easy for 40 mm, then five times as hard.
Granted uneven(double offset) {
  return {cells_of(60, offset, [](int n) { return n < 40 ? 1.0 : 5.0; }), offset, 60};
}

TEST(StopMarginTable, KeepsTheLimitsOfTheCellsThatAStopPasses) {
  for (const double offset : {0.0, 17.0}) {
    const Granted got = uneven(offset);
    for (const bool is_fault : {false, true}) {
      EXPECT_LE(got.use(is_fault, offset).acceleration[0], 1 + 1e-9);
      EXPECT_LE(got.use(is_fault, offset).jerk[0], 1 + 1e-9);
      EXPECT_GT(got.use(is_fault, offset).jerk[0], 0.98);
    }
  }
}

TEST(StopMarginTable, CutsPhasesSoThatStopsOnTheEasyStretchUseMore) {
  const Granted got = uneven(0);
  EXPECT_FALSE(got.cuts.empty());
  double easy = 0, hard = 1e9;
  for (const TimePiece& time : got.times) {
    if (time.s0 < 30) easy = std::max(easy, time.stop_jerk);
    if (time.s0 > 41) hard = std::min(hard, time.stop_jerk);
  }
  EXPECT_NEAR(easy, 20000, 20000 * 0.1);
  EXPECT_NEAR(hard, 4000, 4000 * 0.1);
  // Up to where a stop would reach the hard stretch, nearly all of the easy one's is granted.
  for (const TimePiece& time : got.times) {
    const StopLaw law(state_at(time, time.duration), {1000, 20000});
    const double rest = state_at(time, time.duration).s + law.distance();
    if (rest < 30) {
      EXPECT_GT(time.stop_jerk, 15000) << time.s0;
    }
  }
}

TEST(StopMarginTable, CutsNoMoreThanItHasTo) {
  const Granted got = uneven(0);
  EXPECT_GE(got.cuts.size(), 8U);
  EXPECT_LE(got.cuts.size(), 12U);
}

/// Of what stops may use, over the time of the motion.
double average_of_stops(const Granted& got) {
  double sum = 0, duration = 0;
  for (const TimePiece& time : got.times) {
    sum += time.duration * time.rest_stop_accel;
    duration += time.duration;
  }
  return sum / duration;
}

/// Paths so short that a stop goes over many of their cells.
TEST(StopMarginTable, OnAShortPathAFewCutsGiveStopsMostOfWhatThereIs) {
  const Granted harder(cells_of(10, 0, [](int n) { return n < 6 ? 1.0 : 5.0; }), 0, 10);
  EXPECT_LE(harder.cuts.size(), 6U);
  EXPECT_GT(average_of_stops(harder), 470) << "1000 before the hard stretch, 200 on it";
  const Granted bump(cells_of(20, 0, [](int n) { return n == 10 ? 3.0 : 1.0; }), 0, 20);
  EXPECT_LE(bump.cuts.size(), 9U);
  EXPECT_GT(average_of_stops(bump), 837.5) << "1000 beside the bump, 333 on it";
  for (const Granted* got : {&harder, &bump}) {
    EXPECT_LE(got->use(false, 0).acceleration[0], 1 + 1e-9);
    EXPECT_LE(got->use(false, 0).jerk[0], 1 + 1e-9);
  }
}

TEST(StopMarginTable, CutsNoPhaseWhereCellsDifferLittle) {
  const Granted got(cells_of(60, 0, [](int n) { return n < 40 ? 1.0 : 1.05; }), 0, 60);
  EXPECT_TRUE(got.cuts.empty());
}

TEST(StopMarginTable, HasNoMoreCutsThanThereIsRoomFor) {
  const Granted got(cells_of(400, 0, [](int n) { return 1.0 + (n % 7) * 0.5; }), 0, 400);
  EXPECT_LE(got.cuts.size(), 7U * StopMarginTable::kMaxCuts);
  EXPECT_LE(got.use(false, 0).jerk[0], 1 + 1e-9);
}

}  // namespace
}  // namespace meridian::test::stop_margin_table
