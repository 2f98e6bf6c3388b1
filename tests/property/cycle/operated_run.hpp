// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "property/cycle/program_run.hpp"

/// An operator at random and a fault at any instant, for machines that run a program.
namespace meridian::test {

/// What an operator does who cannot leave a machine alone.
struct Operator {
  double min_override = 0;  ///< to which the feed is turned
  bool turns_rapids = true;
  double min_wait_s = 0.01, max_wait_s = 1;   ///< from word to word
  double hold_share = 0.5, feed_share = 0.3;  ///< of the words
  double raise_share = 0;                     ///< of the feed's, above 100 % alone
  int holds = 0;

  /// Runs for `max_s` of motion or to the end of the program; returns how long.
  template <class Run>
  double operate(Run& run, RandomPrograms& random, double max_s) {
    double next = 0, t = 0;
    for (; t < max_s && !run.is_over(); t += run.world.dt()) {
      if (t < next) {
        run.run();
        continue;
      }
      next = t + random.log_uniform(min_wait_s, max_wait_s);
      act(run, random);
    }
    return t;
  }

 private:
  template <class Run>
  void act(Run& run, RandomPrograms& random) {
    const double what = random.uniform(0, 1);
    if (run.world.now() == State::kHeld) {
      run.command(Verb::kResume);
    } else if (what < hold_share) {
      run.command(Verb::kHold);
      ++holds;
    } else if (what < hold_share + feed_share) {
      const bool is_raise = raise_share > 0 && random.chance(raise_share);
      run.command(Verb::kFeedOverride, std::min(run.world.machine.max_feed_override,
                                                random.uniform(is_raise ? 1 : min_override, 1.5)));
    } else if (turns_rapids) {
      run.command(Verb::kRapidOverride, random.uniform(0.2, 1.0));
    }
  }
};

/// Runs for `until_s`, then a drive faults. False where the program was over before.
template <class Run>
[[nodiscard]] bool run_into_fault(Run& run, double until_s) {
  for (double t = 0; t < until_s && !run.is_over(); t += run.world.dt()) run.run();
  if (run.is_over()) return false;
  run.world.in.feedback.fault_mask = 1;
  return true;
}

/// No limit is passed from record `first` on; `worst` remembers.
inline void expect_within_limits(const CycleWorld& world, std::size_t first, bool is_fault,
                                 LimitShares& worst) {
  const LimitShares shares = shares_of_limits(world, first, is_fault);
  EXPECT_LE(std::max({shares.v, shares.a, shares.j}), 1 + 1e-6)
      << "v " << shares.v << " a " << shares.a << " j " << shares.j;
  worst.take(shares);
}

/// Calls `check` with every `step`th record from `first` on that moves along the program, and its
/// tool pose.
template <class Check>
void for_each_cut(const MachineModel& machine, const std::vector<CycleRecord>& records,
                  std::size_t first, std::size_t step, const Check& check) {
  for (std::size_t k = first; k < records.size(); k += step) {
    const CycleRecord& record = records[k];
    if ((record.setpoint.flags & kSetpointMoving) == 0) continue;
    if (record.motion == MotionKind::kApproach) continue;
    check(record, forward(machine, machine.tool_length_mm, record.joints));
  }
}

}  // namespace meridian::test
