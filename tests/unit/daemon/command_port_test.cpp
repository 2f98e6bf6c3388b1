// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/command_port.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "unit/cycle/program.hpp"

namespace meridian::interpolator {
namespace {

using test::Program;

/// A machine whose cycle takes its commands from a port.
struct Operated {
  explicit Operated(State begin = State::kReady) : program(begin) {}

  void say(Verb verb, double argument = 0) {
    EXPECT_TRUE(port.stage({++program.world.request, verb, argument}));
  }
  /// What was said until now comes in one burst.
  void run(int cycles) {
    port.publish();
    for (int n = 0; n < cycles; ++n) {
      program.world.in.has_command = port.try_pop(program.world.in.command);
      program.world.run();
    }
  }
  [[nodiscard]] std::size_t count(EventCode code, Verb verb) const {
    const auto is_meant = [=](const Event& e) {
      return e.code == code && static_cast<Verb>(e.b) == verb;
    };
    const auto& events = program.world.events;
    return static_cast<std::size_t>(std::count_if(events.begin(), events.end(), is_meant));
  }
  [[nodiscard]] std::size_t count_overtaken() const {
    const auto is_overtaken = [](const Event& e) {
      return e.code == EventCode::kRefused && static_cast<Refusal>(e.x) == Refusal::kOvertaken;
    };
    const auto& events = program.world.events;
    return static_cast<std::size_t>(std::count_if(events.begin(), events.end(), is_overtaken));
  }

  Program program;
  CommandPort port;
};

TEST(CommandPort, LetsAHoldDecelerateAtOnceWhateverWaits) {
  Operated machine;
  test::CycleWorld& world = machine.program.world;
  machine.program.plan.cut(Vector3(0, 50, 0), test::kLimits);
  machine.program.run(0.3);
  const double speed = world.state.on_path.ds;
  ASSERT_GT(speed, 1);
  for (int n = 0; n < 60; ++n) machine.say(Verb::kFeedOverride, 1);
  machine.say(Verb::kHold);
  machine.run(2);
  EXPECT_EQ(world.now(), State::kHolding);
  EXPECT_LT(world.state.on_path.ds, speed);
  machine.run(60);
  EXPECT_EQ(machine.count(EventCode::kAccepted, Verb::kFeedOverride), 60U) << "none is lost";
}

TEST(CommandPort, LetsNothingMoveThatWasSaidBeforeAnAbort) {
  Operated machine;
  test::CycleWorld& world = machine.program.world;
  machine.program.plan.cut(Vector3(0, 50, 0), test::kLimits);
  ASSERT_TRUE(world.run_until(State::kLoaded, 1));
  const JointVector at = world.state.joints;
  machine.say(Verb::kStart);
  machine.say(Verb::kAbort);
  machine.run(20);
  EXPECT_EQ(world.state.joints, at);
  EXPECT_EQ(world.now(), State::kReady);
  EXPECT_EQ(machine.count_overtaken(), 1U);
}

struct Burst {
  State state;
  Verb first, stop;
};

class OvertakenBy : public testing::TestWithParam<Burst> {};

/// Also where there is nothing to stop, and the stop is refused.
TEST_P(OvertakenBy, AStopIsWhatWasSaidBefore) {
  Operated machine(GetParam().state == State::kOff ? State::kOff : State::kReady);
  test::CycleWorld& world = machine.program.world;
  if (GetParam().state == State::kHeld) {
    machine.program.plan.cut(Vector3(0, 50, 0), test::kLimits);
    machine.program.run(0.3);
    machine.say(Verb::kHold);
    machine.run(400);
  } else {
    world.in.session = 0;
    machine.run(1);
  }
  ASSERT_EQ(world.now(), GetParam().state);
  const JointVector at = world.state.joints;
  machine.say(GetParam().first);
  machine.say(GetParam().stop);
  machine.run(2);
  EXPECT_EQ(machine.count_overtaken(), 1U);
  EXPECT_EQ(world.state.joints, at);
  machine.run(20);
  EXPECT_FALSE(is_on_path(world.now())) << name_of(world.now());
  machine.say(GetParam().first);
  machine.run(1);
  EXPECT_EQ(machine.count_overtaken(), 1U) << "what is said after the stop has its turn";
}

INSTANTIATE_TEST_SUITE_P(CommandPort, OvertakenBy,
                         testing::Values(Burst{State::kHeld, Verb::kResume, Verb::kHold},
                                         Burst{State::kHeld, Verb::kResume, Verb::kAbort},
                                         Burst{State::kHeld, Verb::kResume, Verb::kDisable},
                                         Burst{State::kOff, Verb::kEnable, Verb::kDisable},
                                         Burst{State::kReady, Verb::kJog, Verb::kHold},
                                         Burst{State::kReady, Verb::kHome, Verb::kAbort}));

TEST(CommandPort, RefusesWordsThatFindNoRoomAndNoStop) {
  CommandPort port;
  std::uint64_t request = 0;
  while (port.stage({++request, Verb::kFeedOverride, 1})) {
  }
  EXPECT_EQ(request, 65U);
  EXPECT_TRUE(port.stage({100, Verb::kHold, 0}));
  EXPECT_TRUE(port.stage({101, Verb::kAbort, 0}));
  EXPECT_TRUE(port.stage({102, Verb::kHold, 0})) << "stands for both";
  port.publish();
  Command command;
  for (const auto& [stop, number] : {std::pair{Verb::kAbort, 101U}, {Verb::kHold, 102U}}) {
    ASSERT_TRUE(port.try_pop(command));
    EXPECT_EQ(command.verb, stop);
    EXPECT_EQ(command.request, number);
  }
  for (std::uint64_t n = 1; n <= 64; ++n) {
    ASSERT_TRUE(port.try_pop(command));
    EXPECT_EQ(command.request, n);
  }
  EXPECT_FALSE(port.try_pop(command));
}

/// Each start comes with an abort, while the cycle looks at a row that is empty: it must have seen
/// the abort when it takes the start.
TEST(CommandPort, NeverShowsAWordAheadOfTheStopThatCameWithIt) {
  constexpr std::uint64_t kBursts = 20'000;
  const auto port = std::make_unique<CommandPort>();
  std::atomic<std::uint64_t> started{0};
  std::thread commands([&] {
    for (std::uint64_t n = 1; n <= kBursts; ++n) {
      while (started.load(std::memory_order_relaxed) != n - 1) std::this_thread::yield();
      static_cast<void>(port->stage({2 * n, Verb::kStart, 0}));
      static_cast<void>(port->stage({2 * n + 1, Verb::kAbort, 0}));
      port->publish();
    }
  });
  std::uint64_t stopped = 0, overtaking = 0, looks = 0;
  Command command;
  while (started.load(std::memory_order_relaxed) < kBursts) {
    if (!port->try_pop(command)) {
      if (++looks % 64 == 0) std::this_thread::yield();
      continue;
    }
    if (command.verb == Verb::kAbort) stopped = command.request;
    if (command.verb != Verb::kStart) continue;
    overtaking += command.request > stopped ? 1 : 0;
    started.fetch_add(1, std::memory_order_relaxed);
  }
  commands.join();
  EXPECT_EQ(overtaking, 0U);
}

}  // namespace
}  // namespace meridian::interpolator
