// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "support/alarm_letter.hpp"
#include "support/document_table.hpp"
#include "support/draws.hpp"
#include "unit/daemon/rehearsal.hpp"

/// Every fault that can be rehearsed in every phase of the machine. The table of docs/faults.md is
/// what this test finds.
namespace meridian::test {
namespace {

enum class Way { kOnLine, kElsewhere, kNone };  ///< where the tip is commanded to be

/// What the machine is doing when the fault comes.
struct Phase {
  const char* name;
  Way way;
  void (*begin)(Rehearsal&);
  bool is_unreferenced = false;
};

void cut_and_run(Rehearsal& plant, double seconds) {
  EXPECT_TRUE(plant.enable());
  plant.plan.cut({60, 0, 0}, kRehearsalLimits);
  plant.plan.barrier(TimeKind::kEnd);
  plant.run(seconds);
}

void cut_to_barrier(Rehearsal& plant, TimeKind kind) {
  EXPECT_TRUE(plant.enable());
  plant.plan.cut({10, 0, 0}, kRehearsalLimits);
  plant.plan.barrier(kind, 10);
  plant.run(0.5);
}

void lay_hand_on(Rehearsal& plant) {
  plant.world.in.session = 0;
  EXPECT_TRUE(plant.enable());
  plant.say(Verb::kJog, 0);
  plant.jog(0, 100, 0.2);
  EXPECT_EQ(plant.world.now(), State::kJogging);
}

void hold(Rehearsal& plant) {
  cut_and_run(plant, 0.3);
  plant.say(Verb::kHold);
}

void starve(Rehearsal& plant) {
  EXPECT_TRUE(plant.enable());
  plant.plan.cut_with_tail({200, 0, 0}, kRehearsalLimits, 0.1);
  plant.run(0.25);
  EXPECT_EQ(plant.world.now(), State::kStarving);
}

/// A probing move that has been under way for a while.
void probe_and_run(Rehearsal& plant) {
  plant.probe = ProbeInput::kFree;
  EXPECT_TRUE(plant.enable());
  plant.plan.cut({60, 0, 0}, kRehearsalLimits);
  plant.plan.barrier(TimeKind::kEnd);
  plant.run(0.3, kStartProbing);
  EXPECT_EQ(plant.world.state.probing.state, ProbeState::kSeeking);
}

const std::array<Phase, 26> kPhases{{
    {"Off", Way::kNone, [](Rehearsal& plant) { plant.cycle(); }},
    {"Enabling", Way::kNone,
     [](Rehearsal& plant) {
       plant.cycle();
       plant.say(Verb::kEnable);
     }},
    {"Ready", Way::kOnLine, [](Rehearsal& plant) { EXPECT_TRUE(plant.enable()); }},
    {"Loaded", Way::kOnLine,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.plan.cut({60, 0, 0}, kRehearsalLimits);
       EXPECT_TRUE(plant.until(State::kLoaded, 1));
     }},
    {"Approaching", Way::kOnLine,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.plan.cut({60, 0, 0}, kRehearsalLimits, MotionKind::kApproach);
       plant.run(0.3);
       EXPECT_EQ(plant.world.now(), State::kApproaching);
     }},
    {"Running, speeding up", Way::kOnLine, [](Rehearsal& plant) { cut_and_run(plant, 0.05); }},
    {"Running", Way::kOnLine, [](Rehearsal& plant) { cut_and_run(plant, 0.3); }},
    {"Running, slowing down", Way::kOnLine, [](Rehearsal& plant) { cut_and_run(plant, 0.66); }},
    {"Running at 30 %", Way::kOnLine,
     [](Rehearsal& plant) {
       cut_and_run(plant, 0.2);
       plant.say(Verb::kFeedOverride, 0.3);
       plant.wait(0.3);
     }},
    {"Running, in a dwell", Way::kOnLine,
     [](Rehearsal& plant) { cut_to_barrier(plant, TimeKind::kDwell); }},
    {"Running, at an action", Way::kOnLine,
     [](Rehearsal& plant) { cut_to_barrier(plant, TimeKind::kAction); }},
    {"Holding", Way::kOnLine,
     [](Rehearsal& plant) {
       hold(plant);
       plant.wait(0.02);
     }},
    {"Held", Way::kOnLine,
     [](Rehearsal& plant) {
       hold(plant);
       EXPECT_TRUE(plant.until(State::kHeld, 1));
     }},
    {"Stepping", Way::kOnLine,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.say(Verb::kSingleBlock, 1);
       plant.plan.cut({10, 0, 0}, kRehearsalLimits);
       plant.plan.cut({10, 0, 0}, kRehearsalLimits);
       plant.run(0);
       EXPECT_TRUE(plant.until(State::kStepping, 1));
     }},
    {"Running, resumed", Way::kOnLine,
     [](Rehearsal& plant) {
       hold(plant);
       EXPECT_TRUE(plant.until(State::kHeld, 1));
       plant.say(Verb::kResume);
       plant.wait(0.05);
     }},
    {"Starving", Way::kOnLine, starve},
    {"Starved", Way::kOnLine,
     [](Rehearsal& plant) {
       starve(plant);
       EXPECT_TRUE(plant.until(State::kStarved, 1));
     }},
    {"Aborting", Way::kOnLine,
     [](Rehearsal& plant) {
       cut_and_run(plant, 0.3);
       plant.say(Verb::kAbort);
       plant.wait(0.02);
     }},
    {"Disabling", Way::kNone,
     [](Rehearsal& plant) {
       EXPECT_TRUE(plant.enable());
       plant.say(Verb::kDisable);
       EXPECT_EQ(plant.world.now(), State::kDisabling);
     }},
    {"Jogging", Way::kElsewhere, lay_hand_on},
    {"Jogging, let go", Way::kElsewhere,
     [](Rehearsal& plant) {
       lay_hand_on(plant);
       plant.say(Verb::kHold);
       plant.wait(0.01);
     }},
    {"Probing", Way::kOnLine, probe_and_run},
    {"Probing, held", Way::kOnLine,
     [](Rehearsal& plant) {
       probe_and_run(plant);
       plant.say(Verb::kHold);
       EXPECT_TRUE(plant.until(State::kHeld, 1));
     }},
    {"Probing, behind its contact", Way::kOnLine,
     [](Rehearsal& plant) {
       probe_and_run(plant);
       plant.probe = ProbeInput::kContact;
       plant.wait(0.01);
       EXPECT_EQ(plant.world.now(), State::kAborting);
     }},
    {"Homing", Way::kNone,
     [](Rehearsal& plant) {
       plant.world.in.session = 0;
       EXPECT_TRUE(plant.enable());
       plant.say(Verb::kHome);
       plant.wait(0.1);
       EXPECT_EQ(plant.world.now(), State::kHoming);
     },
     true},
    {"FaultStop of the stop input", Way::kOnLine,
     [](Rehearsal& plant) {
       cut_and_run(plant, 0.3);
       plant.inject("emergency");
       plant.wait(0.005);
       EXPECT_EQ(plant.world.now(), State::kFaultStop);
     }},
}};

constexpr std::array<const char*, 20> kFaults{
    "fault:theta2", "unpowered:b2",    "blocked:*",   "lag:*=500", "frozen:*",
    "spike:b3=10",  "nan:theta1",      "mute:theta1", "silence",   "dead",
    "emergency",    "unreferenced:b4", "deaf=3",      "deaf=100",  "late=20",
    "untold",       "stale=10",        "stale=100",   "doubled",   "swapped"};

/// The machine can be enabled again once everything is mended.
void expect_recovery(Rehearsal& plant) {
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

/// What comes of `fault` in `phase`: the letter of the alarm behind a FaultStop, or a dot.
std::string outcome(const Phase& phase, const char* fault) {
  SCOPED_TRACE(testing::Message() << fault << " in " << phase.name);
  const drives::HomingPlan homing{.is_referenced = !phase.is_unreferenced};
  auto plant = std::make_unique<Rehearsal>(std::vector<drives::HomingPlan>(5, homing));
  phase.begin(*plant);
  const std::size_t first = plant->world.records.size();
  plant->inject(fault);
  const bool is_fault = plant->until(State::kFault, 6);
  if (phase.way == Way::kOnLine) {
    EXPECT_LE(plant->deviation(first), 1e-9) << "mm off the path";
  }
  if (phase.way != Way::kNone) {
    EXPECT_LE(plant->acceleration(first), 1 + 1e-6);
  }
  EXPECT_NE(plant->world.now(), State::kFaultStop);
  const Alarm alarm = plant->world.state.alarm;
  if (is_fault) {
    EXPECT_EQ(plant->world.records.back().setpoint.flags & kSetpointEnabled, 0);
  }
  expect_recovery(*plant);
  return is_fault ? letter_of(alarm) : "·";
}

std::string faults_and_phases() {
  std::ostringstream text;
  text << kFaults.size() << " faults in " << kPhases.size() << " phases, "
       << kFaults.size() * kPhases.size() << " pairs:\n\n| |";
  for (const std::string_view fault : kFaults) {
    const bool has_number =
        fault.starts_with("deaf") || fault.starts_with("late") || fault.starts_with("stale");
    text << " `" << fault.substr(0, fault.find_first_of(has_number ? "" : ":=")) << "` |";
  }
  text << "\n|---|";
  for (std::size_t i = 0; i < kFaults.size(); ++i) text << "---|";
  for (const Phase& phase : kPhases) {
    text << "\n| " << phase.name << " |";
    for (const char* fault : kFaults) text << ' ' << outcome(phase, fault) << " |";
  }
  text << '\n';
  return text.str();
}

TEST(FaultPhases, EndAsTheDocumentSaysOnThePathInsideLimitsAndCanBeMended) {
  if (!kIsTimed) {  // a sanitizer sees the same code in some of the pairs
    for (std::size_t n = 0; n < kFaults.size() * kPhases.size(); n += 13) {
      (void)outcome(kPhases[n % kPhases.size()], kFaults[n % kFaults.size()]);
    }
    return;
  }
  expect_table_of_document(MERIDIAN_SOURCE_DIR "/docs/faults.md", "phases", faults_and_phases());
}

}  // namespace
}  // namespace meridian::test
