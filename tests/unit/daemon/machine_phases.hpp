// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>

#include "unit/daemon/rehearsal.hpp"

/// Every phase of the machine, for tables of what comes of a fault in each.
namespace meridian::test {

enum class TipAt { kOnLine, kElsewhere, kNone };  ///< where the tip is commanded to be

/// What the machine is doing when the fault comes.
struct Phase {
  const char* name;
  TipAt tip_at;
  void (*begin)(Rehearsal&);
  bool is_unreferenced = false;
};

inline void cut_and_run(Rehearsal& plant, double seconds) {
  EXPECT_TRUE(plant.enable());
  plant.plan.cut({60, 0, 0}, kRehearsalLimits);
  plant.plan.barrier(TimeKind::kEnd);
  plant.run(seconds);
}

inline void cut_to_barrier(Rehearsal& plant, TimeKind kind) {
  EXPECT_TRUE(plant.enable());
  plant.plan.cut({10, 0, 0}, kRehearsalLimits);
  plant.plan.barrier(kind, 10);
  plant.run(0.5);
}

inline void lay_hand_on(Rehearsal& plant) {
  plant.world.in.session = 0;
  EXPECT_TRUE(plant.enable());
  plant.say(Verb::kJog, 0);
  plant.jog(0, 100, 0.2);
  EXPECT_EQ(plant.world.now(), State::kJogging);
}

inline void hold(Rehearsal& plant) {
  cut_and_run(plant, 0.3);
  plant.say(Verb::kHold);
}

inline void starve(Rehearsal& plant) {
  EXPECT_TRUE(plant.enable());
  plant.plan.cut_with_tail({200, 0, 0}, kRehearsalLimits, 0.1);
  plant.run(0.25);
  EXPECT_EQ(plant.world.now(), State::kStarving);
}

/// A probing move that has been under way for a while.
inline void probe_and_run(Rehearsal& plant) {
  plant.probe = ProbeInput::kFree;
  EXPECT_TRUE(plant.enable());
  plant.plan.cut({60, 0, 0}, kRehearsalLimits);
  plant.plan.barrier(TimeKind::kEnd);
  plant.run(0.3, kStartProbing);
  EXPECT_EQ(plant.world.state.probing.state, ProbeState::kSeeking);
}

inline const std::array<Phase, 26> kMachinePhases{{
    {"Off", TipAt::kNone, [](Rehearsal& plant) { plant.cycle(); }},
    {"Enabling", TipAt::kNone,
     [](Rehearsal& plant) {
       plant.cycle();
       plant.say(Verb::kEnable);
     }},
    {"Ready", TipAt::kOnLine, [](Rehearsal& plant) { EXPECT_TRUE(plant.enable()); }},
    {"Loaded", TipAt::kOnLine,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.plan.cut({60, 0, 0}, kRehearsalLimits);
       EXPECT_TRUE(plant.until(State::kLoaded, 1));
     }},
    {"Approaching", TipAt::kOnLine,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.plan.cut({60, 0, 0}, kRehearsalLimits, MotionKind::kApproach);
       plant.run(0.3);
       EXPECT_EQ(plant.world.now(), State::kApproaching);
     }},
    {"Running, speeding up", TipAt::kOnLine, [](Rehearsal& plant) { cut_and_run(plant, 0.05); }},
    {"Running", TipAt::kOnLine, [](Rehearsal& plant) { cut_and_run(plant, 0.3); }},
    {"Running, slowing down", TipAt::kOnLine, [](Rehearsal& plant) { cut_and_run(plant, 0.66); }},
    {"Running at 30 %", TipAt::kOnLine,
     [](Rehearsal& plant) {
       cut_and_run(plant, 0.2);
       plant.say(Verb::kFeedOverride, 0.3);
       plant.wait(0.3);
     }},
    {"Running, in a dwell", TipAt::kOnLine,
     [](Rehearsal& plant) { cut_to_barrier(plant, TimeKind::kDwell); }},
    {"Running, at an action", TipAt::kOnLine,
     [](Rehearsal& plant) { cut_to_barrier(plant, TimeKind::kAction); }},
    {"Holding", TipAt::kOnLine,
     [](Rehearsal& plant) {
       hold(plant);
       plant.wait(0.02);
     }},
    {"Held", TipAt::kOnLine,
     [](Rehearsal& plant) {
       hold(plant);
       EXPECT_TRUE(plant.until(State::kHeld, 1));
     }},
    {"Stepping", TipAt::kOnLine,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.say(Verb::kSingleBlock, 1);
       plant.plan.cut({10, 0, 0}, kRehearsalLimits);
       plant.plan.cut({10, 0, 0}, kRehearsalLimits);
       plant.run(0);
       EXPECT_TRUE(plant.until(State::kStepping, 1));
     }},
    {"Running, resumed", TipAt::kOnLine,
     [](Rehearsal& plant) {
       hold(plant);
       EXPECT_TRUE(plant.until(State::kHeld, 1));
       plant.say(Verb::kResume);
       plant.wait(0.05);
     }},
    {"Starving", TipAt::kOnLine, starve},
    {"Starved", TipAt::kOnLine,
     [](Rehearsal& plant) {
       starve(plant);
       EXPECT_TRUE(plant.until(State::kStarved, 1));
     }},
    {"Aborting", TipAt::kOnLine,
     [](Rehearsal& plant) {
       cut_and_run(plant, 0.3);
       plant.say(Verb::kAbort);
       plant.wait(0.02);
     }},
    {"Disabling", TipAt::kNone,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.say(Verb::kDisable);
       EXPECT_EQ(plant.world.now(), State::kDisabling);
     }},
    {"Jogging", TipAt::kElsewhere, lay_hand_on},
    {"Jogging, let go", TipAt::kElsewhere,
     [](Rehearsal& plant) {
       lay_hand_on(plant);
       plant.say(Verb::kHold);
       plant.wait(0.01);
     }},
    {"Probing", TipAt::kOnLine, probe_and_run},
    {"Probing, held", TipAt::kOnLine,
     [](Rehearsal& plant) {
       probe_and_run(plant);
       plant.say(Verb::kHold);
       EXPECT_TRUE(plant.until(State::kHeld, 1));
     }},
    {"Probing, after its contact", TipAt::kOnLine,
     [](Rehearsal& plant) {
       probe_and_run(plant);
       plant.probe = ProbeInput::kContact;
       plant.wait(0.01);
       EXPECT_EQ(plant.world.now(), State::kAborting);
     }},
    {"Homing", TipAt::kNone,
     [](Rehearsal& plant) {
       plant.world.in.session = 0;
       EXPECT_TRUE(plant.enable());
       plant.say(Verb::kHome);
       plant.wait(0.1);
       EXPECT_EQ(plant.world.now(), State::kHoming);
     },
     true},
    {"FaultStop of the stop input", TipAt::kOnLine,
     [](Rehearsal& plant) {
       cut_and_run(plant, 0.3);
       plant.inject("emergency");
       plant.wait(0.005);
       EXPECT_EQ(plant.world.now(), State::kFaultStop);
     }},
}};

/// The machine can be enabled again once everything is mended.
inline void expect_recovery(Rehearsal& plant) {
  const bool is_fault = plant.world.now() == State::kFault;
  plant.mend();
  if (is_fault) {
    EXPECT_TRUE(plant.do_drives_stand());
    plant.say(Verb::kReset);
  } else {
    plant.say(Verb::kAbort);
    plant.wait(0.5);
    plant.say(Verb::kDisable);
    EXPECT_TRUE(plant.until(State::kOff, 1) && plant.do_drives_stand());
  }
  ASSERT_EQ(plant.world.now(), State::kOff);
  EXPECT_TRUE(plant.enable()) << "it works again";
}

}  // namespace meridian::test
