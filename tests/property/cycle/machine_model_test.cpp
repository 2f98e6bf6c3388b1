// SPDX-License-Identifier: Apache-2.0
#include "property/cycle/machine_model.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "unit/cycle/program.hpp"

namespace meridian::test {
namespace {

[[nodiscard]] Table changed(State state, Verb verb, State next) {
  return [=](State s, Verb v) {
    return s == state && v == verb ? state_table::go(next) : effect_of(s, v);
  };
}

[[nodiscard]] Exploration check(const Table& table, bool voids_words = true) {
  const OperatedMachine machine(table, voids_words);
  const Exploration found = explore<Machine>(
      Machine{}, [&](const Machine& m) { return machine.steps(m); }, key_of,
      [&](const Machine& m) {
        const std::string complaint = complaint_of(m);
        if (!complaint.empty()) return complaint;
        return machine.can_be_switched_off(m) ? "" : std::string("it cannot be switched off");
      },
      1'000'000);
  std::printf("%zu states, %zu steps%s\n", found.states, found.steps,
              found.complaint.empty() ? "" : (": " + found.text()).c_str());
  return found;
}

TEST(MachineStates, NeverMoveWithoutTheOperatorNorAfterAFaultAndCanAlwaysBeSwitchedOff) {
  const Exploration found = check(effect_of);
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(found.complaint, "") << found.text();
}

TEST(MachineStates, CatchATableThatStartsOutOfAFault) {
  EXPECT_EQ(check(changed(State::kFault, Verb::kStart, State::kRunning)).complaint,
            "motion after a fault");
}

TEST(MachineStates, CatchATableWhereEnablingRuns) {
  EXPECT_EQ(check(changed(State::kHeld, Verb::kEnable, State::kRunning)).complaint,
            "motion that no operator started");
}

TEST(MachineStates, CatchATableThatDisablesInMotion) {
  EXPECT_EQ(check(changed(State::kRunning, Verb::kDisable, State::kDisabling)).complaint,
            "the program is dropped in motion");
}

TEST(MachineStates, CatchATableThatEndsADryRunWhileTheMachineIsOn) {
  const Table loose = [](State s, Verb v) {
    return s == State::kReady && v == Verb::kDryRun ? state_table::kValue : effect_of(s, v);
  };
  EXPECT_EQ(check(loose).complaint, "drives are led from a place that they did not report");
}

TEST(MachineStates, CatchAStartThatOutlivesTheStopBehindIt) {
  EXPECT_EQ(check(effect_of, false).complaint, "motion from before a stop");
}

TEST(MachineStates, CatchATableThatResetDoesNotLeave) {
  const Table stuck = [](State s, Verb v) {
    return s == State::kFault ? state_table::kNo : effect_of(s, v);
  };
  EXPECT_EQ(check(stuck).complaint, "it cannot be switched off");
}

/// From state to state as the model does it, whatever the conditions.
[[nodiscard]] std::set<std::pair<State, State>> edges_of_model() {
  std::set<std::pair<State, State>> edges;
  const OperatedMachine machine(effect_of);
  static_cast<void>(explore<Machine>(
      Machine{},
      [&](const Machine& m) {
        auto steps = machine.steps(m);
        for (const auto& step : steps) edges.emplace(m.state, step.state.state);
        return steps;
      },
      key_of, [](const Machine&) { return std::string(); }, 1'000'000));
  return edges;
}

/// What the real cycle does under verbs, faults and blocks drawn at random are edges of the model,
/// and it keeps the same rules.
TEST(MachineStates, AreThoseOfTheRealCycle) {
  const auto edges = edges_of_model();
  std::set<std::pair<State, State>> seen;
  constexpr std::uint64_t kSeed = 5;
  std::mt19937_64 random(kSeed);
  constexpr int kHands = 7, kVerbs = kHands + 2;  // enable to reset, then jog and home
  std::uint64_t orders = 0;
  int passed = 0;
  const auto draw = [&random](int n) { return std::uniform_int_distribution(0, n - 1)(random); };
  for (int walk = 0; walk < 60; ++walk) {
    Program program(State::kOff);
    CycleWorld& world = program.world;
    world.state.options.enable_timeout_s = 0.05;
    std::optional<MadePlan> plan;
    std::uint16_t epoch = 0;
    State before = State::kOff;
    bool is_granted = false, is_clear = true, is_cut_off = false, was_dry_run = false;
    std::optional<Command> waiting;  // a word that is said and waits for its turn
    bool is_passed = false;
    const auto look = [&](const char* step) {
      for (std::size_t i = 0; i < world.out.event_count; ++i) {
        const Event& event = world.out.events[i];
        const auto verb = static_cast<Verb>(event.b);
        const bool is_answer =
            event.code == EventCode::kAccepted || event.code == EventCode::kRefused;
        is_passed = is_passed || (is_answer && waiting && is_stop(verb));
        if (event.code == EventCode::kAccepted) {
          is_granted =
              is_granted || verb == Verb::kStart || verb == Verb::kResume || verb == Verb::kJog;
          if (verb == Verb::kReset && world.now() == State::kOff) is_clear = true;
        }
        if (event.code == EventCode::kStateChanged &&
            static_cast<State>(event.a) == State::kFaultStop) {
          is_clear = false;
        }
      }
      const State now = world.now();
      seen.emplace(before, now);
      ASSERT_TRUE(edges.contains({before, now}))
          << name_of(before) << " to " << name_of(now) << " by " << step;
      const bool is_moving = world.state.velocity != JointVector{};
      ASSERT_FALSE(is_moving && !is_on_path(now)) << name_of(now) << " by " << step;
      ASSERT_FALSE(is_moving && !is_granted) << name_of(now) << " by " << step;
      ASSERT_FALSE(is_moving && !is_clear && now != State::kFaultStop) << name_of(now);
      const std::uint16_t flags = world.out.record.setpoint.flags;
      ASSERT_FALSE(world.state.is_dry_run && (flags & kSetpointEnabled) != 0) << name_of(now);
      ASSERT_FALSE(was_dry_run != world.state.is_dry_run && now != State::kOff) << name_of(now);
      was_dry_run = world.state.is_dry_run;
      if (!is_on_path(now) && now != State::kStarved) is_granted = false;
      before = now;
    };
    for (int letter = 0; letter < 120; ++letter) {
      if (world.state.epoch != epoch) {  // the planner plans anew from where the machine stands
        epoch = world.state.epoch;
        plan.emplace(program.machine, *world.port,
                     forward(program.machine, program.machine.tool_length_mm, world.state.joints));
        plan->set_epoch(epoch);
      }
      const int what = draw(20);
      if (what < kVerbs) {
        const bool is_by_hand = what >= kHands;
        if (is_by_hand && draw(2) == 0) world.in.session = 0;
        const Verb verb = !is_by_hand      ? static_cast<Verb>(what)
                          : what == kHands ? Verb::kJog
                                           : Verb::kHome;
        world.command(verb);
        ASSERT_NO_FATAL_FAILURE(look(name_of(verb)));
      } else if (what < 12 && world.state.epoch == epoch && is_enabled(world.now())) {
        const MotionKind kind = draw(3) == 0 ? MotionKind::kApproach : MotionKind::kCut;
        plan->cut(Vector3(0, draw(2) == 0 ? 3 : -3, 0), kLimits, kind);
        if (draw(4) == 0) plan->barrier(draw(2) == 0 ? TimeKind::kEnd : TimeKind::kStop);
      } else if (what == 12) {
        world.in.feedback.fault_mask ^= draw(6) == 0 || world.in.feedback.fault_mask != 0 ? 1 : 0;
      } else if (what == 13) {
        world.in.feedback.emergency_stop = !world.in.feedback.emergency_stop && draw(6) == 0;
      } else if (what == 14) {
        world.are_drives_alive = draw(6) != 0;
      } else if (what == 15) {
        is_cut_off = draw(6) == 0;
      } else if (what == 16) {
        world.in.session = static_cast<std::uint64_t>(draw(3));
      } else if (what == 18) {
        world.command(Verb::kDryRun, world.state.is_dry_run || draw(2) == 0 ? 0 : 1);
        ASSERT_NO_FATAL_FAILURE(look("dry_run"));
      } else if (what == 19 && !waiting) {
        const auto verb = static_cast<Verb>(draw(kVerbCount));
        if (leads_to_motion(verb)) waiting = Command{++world.request, verb, 0};
      } else if (what == 19) {
        const bool was_passed = is_passed;
        world.in.has_command = true;
        world.in.command = *std::exchange(waiting, std::nullopt);
        is_passed = false;
        world.run();
        ASSERT_NO_FATAL_FAILURE(look(name_of(world.in.command.verb)));
        const Event refused = world.last(EventCode::kRefused);
        const bool is_void = refused.a == world.in.command.request &&
                             static_cast<Refusal>(refused.x) == Refusal::kOvertaken;
        ASSERT_EQ(was_passed, is_void) << name_of(world.in.command.verb);
        passed += was_passed;
      } else if (what == 17 && draw(6) == 0) {
        world.run(20);
        ASSERT_NO_FATAL_FAILURE(look("lost periods"));
      }
      for (int cycles = draw(3) == 0 ? 150 : draw(8); cycles > 0; --cycles) {
        if (is_cut_off) world.in.feedback.enabled_mask = 0;
        world.in.feedback.homing_mask = asked_of(world.state.homing).mode_mask;
        world.in.feedback.homed_mask = cycles % 7 == 0 ? world.in.feedback.homing_mask : 0;
        if (cycles % 10 == 0)
          world.in.jog = {++orders, world.state.epoch,       false, 0, 30.0, 0, 0,
                          0.03,     world.state.jogging.hand};
        world.run();
        ASSERT_NO_FATAL_FAILURE(look("a period"));
      }
    }
  }
  std::printf("seed %lu: %zu of the model's %zu edges between states seen in the real cycle\n",
              static_cast<unsigned long>(kSeed), seen.size(), edges.size());
  EXPECT_GT(seen.size(), 40U) << "the walks must get about";
  EXPECT_GT(passed, 10) << "words that a stop went past";
}

}  // namespace
}  // namespace meridian::test
