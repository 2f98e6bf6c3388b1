// SPDX-License-Identifier: Apache-2.0

/// The cycle makes no heap call, takes no lock and meets no page fault, on every path: program,
/// hold and resume, override, abort, each fault, lost periods, barriers; and with every family of
/// machines and a stage. Counted per thread around step() and its world, whose own storage is sized
/// before.

#include <gtest/gtest.h>

#include <limits>
#include <ostream>
#include <tuple>

#include "service/host/probe/budgets.hpp"
#include "support/family_machines.hpp"
#include "support/heap_watch.hpp"
#include "support/kernel_account.hpp"
#include "support/lock_watch.hpp"
#include "unit/cycle/program.hpp"

namespace meridian {
namespace {

using test::kLimits;
using test::Program;

struct Scenario {
  const char* name;
  void (*run)(Program&);
  State end;
};
void PrintTo(const Scenario& scenario, std::ostream* out) { *out << scenario.name; }

/// Runs the planned cuts until the machine stands somewhere.
void run_on(Program& p, State until) { (void)p.world.run_until(until, 5); }

const Scenario kScenarios[] = {
    {"Off", [](Program& p) { p.world.run_for(0.1); }, State::kLoaded},
    {"WholeProgram",
     [](Program& p) {
       p.run(0.2);
       run_on(p, State::kStarved);
     },
     State::kStarved},
    {"HoldAndResumeAndOverride",
     [](Program& p) {
       p.run(0.2);
       p.world.command(Verb::kFeedOverride, 0.3);
       p.world.run_for(0.05);
       p.world.command(Verb::kHold);
       run_on(p, State::kHeld);
       p.world.command(Verb::kResume);
       p.world.command(Verb::kFeedOverride, 1);
       p.world.run_for(0.1);
     },
     State::kRunning},
    {"Abort",
     [](Program& p) {
       p.run(0.2);
       p.world.command(Verb::kAbort);
       run_on(p, State::kReady);
     },
     State::kReady},
    {"RefusedVerb",
     [](Program& p) {
       p.run(0.2);
       p.world.command(Verb::kReset);
       p.world.command(Verb::kEnable);
     },
     State::kRunning},
    {"LostPeriods",
     [](Program& p) {
       p.run(0.2);
       p.world.run(2);
       p.world.run_for(0.05);
     },
     State::kRunning},
    {"TooManyLostPeriods",
     [](Program& p) {
       p.run(0.2);
       p.world.run(100);
       run_on(p, State::kFault);
     },
     State::kFault},
    {"DryRun",
     [](Program& p) {
       p.world.command(Verb::kDisable);
       (void)p.world.run_until(State::kOff, 1);
       p.world.are_drives_alive = false;
       p.world.command(Verb::kDryRun, 1);
       (void)p.world.enable();
       p.world.command(Verb::kDisable);
       (void)p.world.run_until(State::kOff, 1);
       p.world.command(Verb::kDryRun, 0);
     },
     State::kOff},
    {"DriveFault",
     [](Program& p) {
       p.run(0.2);
       p.world.in.feedback.fault_mask = 4;
       run_on(p, State::kFault);
     },
     State::kFault},
    {"EmergencyStop",
     [](Program& p) {
       p.run(0.2);
       p.world.in.feedback.emergency_stop = true;
       run_on(p, State::kFault);
     },
     State::kFault},
    {"LostFeedback",
     [](Program& p) {
       p.run(0.2);
       p.world.are_drives_alive = false;
       run_on(p, State::kFault);
     },
     State::kFault},
    {"GuardMeetsNaN",
     [](Program& p) {
       p.run(0.2);
       p.world.machine.lai.h_mm = std::numeric_limits<double>::quiet_NaN();
       run_on(p, State::kFault);
     },
     State::kFault},
};

/// A machine in Ready with a plan: two cuts with a dwell between them.
void prepare(Program& p) {
  p.world.records.resize(20'000);  // touched once, so that the test's own rows cost nothing
  p.world.records.clear();
  p.world.events.resize(1'000);
  p.world.events.clear();
  p.plan.cut({20, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kDwell, 0.05);
  p.plan.cut({20, 0, 0}, kLimits);
}

void count_nothing(const Scenario& scenario, const MachineModel& machine) {
  for (const bool is_warm : {false, true}) {  // the first run maps the code of this path
    Program p(State::kReady, machine);
    prepare(p);
    const watch::HeapWatch heap;
    const watch::LockWatch locks;
    const watch::KernelAccount begin = watch::kernel_account();
    scenario.run(p);
    const watch::KernelAccount account = watch::kernel_account() - begin;
    const watch::HeapCalls calls = heap.calls();
    const auto taken = locks.calls().locks;
    EXPECT_LE(calls.allocations + calls.frees, probe::load_budget("cycle_heap_calls").allowed());
    EXPECT_LE(taken, probe::load_budget("cycle_locks").allowed());
    if (is_warm) {
      EXPECT_LE(account.minor_faults + account.major_faults,
                probe::load_budget("cycle_page_faults").allowed());
    }
    EXPECT_EQ(p.world.now(), scenario.end) << "the scenario went another way";
  }
}

class StepWatch : public testing::TestWithParam<Scenario> {};

TEST_P(StepWatch, CountsNothing) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "the sanitizer owns malloc";
  count_nothing(GetParam(), test::lai_machine());
}

INSTANTIATE_TEST_SUITE_P(Paths, StepWatch, testing::ValuesIn(kScenarios),
                         [](const auto& of) { return std::string(of.param.name); });

struct Family {
  const char* name;
  MachineModel (*machine)();
};
void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

/// `model` with limits that its plan keeps.
MachineModel limited(MachineModel model) {
  const MachineModel bench = test::bench_machine();
  for (JointSpec& joint : model.joints) joint.limits = bench.joints[joint.is_rotary ? 3 : 0].limits;
  model.max_feed_mm_per_s = bench.max_feed_mm_per_s;
  return model;
}

const Family kFamilies[] = {
    {"Stage", [] { return test::hybrid_machine(); }},
    {"Chain", [] { return limited(test::trunnion_machine()); }},
    {"Robot5", [] { return limited(test::robot_machine(false)); }},
    {"Robot6", [] { return limited(test::robot_machine(true)); }},
};

class FamilyWatch : public testing::TestWithParam<std::tuple<Family, Scenario>> {};

TEST_P(FamilyWatch, CountsNothing) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "the sanitizer owns malloc";
  const auto& [family, scenario] = GetParam();
  count_nothing(scenario, family.machine());
}

INSTANTIATE_TEST_SUITE_P(Families, FamilyWatch,
                         testing::Combine(testing::ValuesIn(kFamilies),
                                          testing::Values(kScenarios[1], kScenarios[2],
                                                          kScenarios[8])),
                         [](const auto& of) {
                           return std::string(std::get<0>(of.param).name) +
                                  std::get<1>(of.param).name;
                         });

}  // namespace
}  // namespace meridian
