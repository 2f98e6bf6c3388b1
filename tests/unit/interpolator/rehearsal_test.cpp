// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <ostream>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "service/drives/drive_group.hpp"
#include "service/interpolator/drive_words.hpp"
#include "service/interpolator/feedback_merge.hpp"
#include "support/cycle_world.hpp"
#include "support/machines.hpp"
#include "support/made_plan.hpp"

/// Everything that simulated drives can be told to do wrong, done to the cycle while it cuts:
/// cycle, drives and what joins them, without a wire and without a clock.
namespace meridian::interpolator {
namespace {

const ToolPose kRehearsalBegin{{0, 0, 0}, {std::sin(0.3), 0, std::cos(0.3)}};

MachineModel machine_at_begin() {
  MachineModel model = test::lai_machine();
  const JointVector at = solve(model, model.tool_length_mm, kRehearsalBegin, 0, {}).q;
  for (std::size_t i = 0; i < 5; ++i) model.joints[i].home = at[i];
  return model;
}

/// The machine cuts 200 mm along x at 100 mm/s.
struct Rehearsal {
  Rehearsal() {
    world.are_drives_alive = false;  // these are
    report();
  }

  void cycle() {
    const CycleRecord& record = world.run();
    dds::SetpointSample setpoint;
    setpoint.setpoint = record.setpoint;
    group.take(setpoint);
    for (std::uint16_t i = 0; i < 5; ++i) {
      dds::DriveCommand command;
      command.drive = i;
      command.service_id = 7;
      const DriveState is = drive_state(merge.words().statusword[i]);
      command.controlword = next_controlword(is, is_enabled(record.state));
      if (is == DriveState::kFault && is_resetting) command.controlword = controlword::kFaultReset;
      group.take(command);
    }
    group.work(1);
    report();
  }
  void report() {
    if (!group.is_silent()) merge.take(group.feedback(), 7, world.in.now_ns);
    world.in.feedback = merge.feedback();
  }
  [[nodiscard]] bool until(State wanted, double seconds) {
    for (double t = 0; t < seconds && world.now() != wanted; t += world.dt()) cycle();
    return world.now() == wanted;
  }
  void wait(double seconds) {
    for (double t = 0; t < seconds; t += world.dt()) cycle();
  }
  void say(Verb verb) {
    world.in.has_command = true;
    world.in.command = {++world.request, verb, 0};
    cycle();
  }
  [[nodiscard]] bool enable() {
    cycle();
    say(Verb::kEnable);
    return until(State::kReady, 1);
  }
  void start() {
    ASSERT_TRUE(enable());
    plan.cut({200, 0, 0}, {100, 1500, 30000});
    ASSERT_TRUE(until(State::kLoaded, 1));
    say(Verb::kStart);
    wait(0.5);
    ASSERT_EQ(world.now(), State::kRunning);
  }
  /// `text` with the drive that moves fastest for "*".
  void inject(std::string text) {
    const JointVector& v = world.state.velocity;
    fastest = static_cast<int>(
        std::max_element(v.begin(), v.begin() + 3,
                         [](double a, double b) { return std::abs(a) < std::abs(b); }) -
        v.begin());
    if (const std::size_t star = text.find('*'); star != std::string::npos) {
      text.replace(star, 1, model.joints[static_cast<std::size_t>(fastest)].name);
    }
    const auto injection = drives::parse_injection(text, model);
    ASSERT_TRUE(injection.has_value()) << injection.error();
    injected = injection->drive;
    group.inject_now(*injection);
  }
  /// Largest distance of the commanded tip from the programmed line since row `first`, mm.
  [[nodiscard]] double deviation(std::size_t first) const {
    double worst = 0;
    for (std::size_t n = first; n < world.records.size(); ++n) {
      if (world.records[n].state != State::kFaultStop) continue;
      const ToolPose pose = forward(model, model.tool_length_mm, world.records[n].joints);
      worst = std::max(worst, std::hypot(pose.tip[1], pose.tip[2]));
    }
    return worst;
  }
  /// Largest step of what was sent in shares of the FaultStop acceleration, since row `first`.
  [[nodiscard]] double acceleration(std::size_t first) const {
    double worst = 0;
    const auto& r = world.records;
    for (std::size_t n = first; n < r.size() && r[n].state != State::kFault; ++n) {
      for (std::size_t i = 0; i < 5; ++i) {
        const double step = r[n].joints[i] - 2 * r[n - 1].joints[i] + r[n - 2].joints[i];
        worst = std::max(worst, std::abs(step) / (world.dt() * world.dt()) /
                                    model.joints[i].limits.fault_acceleration);
      }
    }
    return worst;
  }

  MachineModel model = machine_at_begin();
  test::CycleWorld world{model};
  test::MadePlan plan{model, *world.port, kRehearsalBegin};
  drives::DriveGroup group{model, {}};
  FeedbackMerge merge;
  bool is_resetting = false;
  int fastest = 0, injected = 0;
};

struct Rehearsed {
  const char* injection;  ///< "*" is the drive that moves fastest
  Alarm alarm;
  Alarm or_alarm;   ///< where drive and service see it in the same cycle
  double within_s;  ///< until FaultStop
  bool names_drive;
};

void PrintTo(const Rehearsed& rehearsed, std::ostream* out) { *out << rehearsed.injection; }

class RehearsedFault : public testing::TestWithParam<Rehearsed> {};

TEST_P(RehearsedFault, StopsOnThePathIsToldAndIsOverWhenItIsMended) {
  const Rehearsed& expected = GetParam();
  auto plant = std::make_unique<Rehearsal>();
  plant->start();
  const std::size_t first = plant->world.records.size();
  plant->inject(expected.injection);
  ASSERT_TRUE(plant->until(State::kFaultStop, expected.within_s)) << "nobody saw it";
  const Alarm alarm = plant->world.state.alarm;
  EXPECT_TRUE(alarm == expected.alarm || alarm == expected.or_alarm) << static_cast<int>(alarm);
  if (expected.names_drive) {
    EXPECT_EQ(plant->world.last(EventCode::kAlarm).b, static_cast<std::uint64_t>(plant->injected));
  }
  ASSERT_TRUE(plant->until(State::kFault, 2));
  EXPECT_LE(plant->deviation(first), 1e-9) << "mm off the path";
  EXPECT_LE(plant->acceleration(first), 1 + 1e-6);
  EXPECT_EQ(plant->world.records.back().setpoint.flags & kSetpointEnabled, 0);

  plant->wait(0.3);
  plant->inject("mend");
  plant->is_resetting = true;
  plant->wait(0.2);
  plant->is_resetting = false;
  for (int i = 0; i < plant->group.size(); ++i) {
    EXPECT_EQ(plant->group.drive(i).velocity(), 0) << "drive " << i << " stands";
  }
  plant->say(Verb::kReset);
  ASSERT_EQ(plant->world.now(), State::kOff);
  EXPECT_TRUE(plant->enable()) << "it works again";
}

std::string name_of_rehearsal(const testing::TestParamInfo<Rehearsed>& info) {
  const char* text = info.param.injection;
  return std::string(text, std::strcspn(text, ":="));
}

INSTANTIATE_TEST_SUITE_P(
    Of, RehearsedFault,
    testing::Values(
        Rehearsed{"fault:theta2", Alarm::kDriveFault, Alarm::kDriveFault, 0.01, true},
        Rehearsed{"blocked:*", Alarm::kFollowingError, Alarm::kDriveFault, 0.2, true},
        Rehearsed{"silence", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.03, false},
        Rehearsed{"emergency", Alarm::kEmergencyStop, Alarm::kEmergencyStop, 0.01, false},
        Rehearsed{"dead", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.03, false},
        Rehearsed{"unpowered:b2", Alarm::kDriveFault, Alarm::kDriveFault, 0.01, true},
        Rehearsed{"unreferenced:b4", Alarm::kReferenceLost, Alarm::kReferenceLost, 0.01, true},
        Rehearsed{"mute:theta1", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.01, true},
        Rehearsed{"frozen:*", Alarm::kFollowingError, Alarm::kFollowingError, 0.2, true},
        Rehearsed{"nan:theta1", Alarm::kFeedbackLost, Alarm::kFeedbackLost, 0.01, true},
        Rehearsed{"spike:theta2=3", Alarm::kFollowingError, Alarm::kFollowingError, 0.01, true},
        Rehearsed{"lag:*=500", Alarm::kFollowingError, Alarm::kDriveFault, 0.3, true},
        Rehearsed{"deaf=100", Alarm::kDriveFault, Alarm::kDriveFault, 0.02, false},
        Rehearsed{"late=20", Alarm::kDriveFault, Alarm::kDriveFault, 0.02, false}),
    name_of_rehearsal);

TEST(RehearsedTrouble, OfSetpointsThatTheDrivesBridgeStopsNothing) {
  auto plant = std::make_unique<Rehearsal>();
  plant->start();
  plant->inject("deaf=3");
  plant->wait(0.2);
  EXPECT_EQ(plant->world.now(), State::kRunning);
  EXPECT_EQ(plant->group.periods_bridged(), 3U);
}

TEST(RehearsedTrouble, OfAReferenceLostAtRestIsToldAtTheStart) {
  auto plant = std::make_unique<Rehearsal>();
  ASSERT_TRUE(plant->enable());
  plant->plan.cut({200, 0, 0}, {100, 1500, 30000});
  ASSERT_TRUE(plant->until(State::kLoaded, 1));
  plant->inject("unreferenced:b2");
  plant->wait(0.1);
  EXPECT_EQ(plant->world.now(), State::kLoaded);
  plant->say(Verb::kStart);
  EXPECT_EQ(plant->world.now(), State::kLoaded);
  EXPECT_EQ(static_cast<Refusal>(plant->world.last(EventCode::kRefused).x),
            Refusal::kNotReferenced);
}

TEST(RehearsedTrouble, OfADriveThatStandsStillAndReportsTheSameForEverIsSeenWhenItMoves) {
  auto plant = std::make_unique<Rehearsal>();
  ASSERT_TRUE(plant->enable());
  plant->inject("frozen:b3");
  plant->inject("frozen:b2");
  plant->inject("frozen:b4");
  plant->wait(0.2);
  EXPECT_EQ(plant->world.now(), State::kReady);
  plant->plan.cut({200, 0, 0}, {100, 1500, 30000});
  ASSERT_TRUE(plant->until(State::kLoaded, 1));
  plant->say(Verb::kStart);
  ASSERT_TRUE(plant->until(State::kFault, 2));
  EXPECT_EQ(plant->world.state.alarm, Alarm::kFollowingError);
}

}  // namespace
}  // namespace meridian::interpolator
