// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <sstream>
#include <string>

#include "service/machine/file/sections/monitoring_file.hpp"
#include "support/alarm_letter.hpp"
#include "support/document_table.hpp"
#include "support/draws.hpp"
#include "unit/daemon/machine_phases.hpp"

/// What the monitoring finds in every phase of the machine, alone: the constant bounds of cycle and
/// drives are wide open. The table of docs/monitoring.md is what this test finds.
namespace meridian::test {
namespace {

/// What is in force beside limited speed, standstill and plausibility.
enum class Also { kNothing, kModel, kWindowAlone, kJointSpeedAlone, kSetUpWindowAlone };

/// Something that only the monitoring can find, or that nobody may find.
struct Unseen {
  const char* name;
  const char* injection;  ///< empty: none
  Also also = Also::kModel;
};

constexpr std::array<Unseen, 15> kUnseen{{{"`creep=5`", "creep:*=5", Also::kNothing},
                                          {"`guard`, nobody holds", "guard", Also::kNothing},
                                          {"`guard`, joints", "guard", Also::kJointSpeedAlone},
                                          {"`guard`, window", "guard", Also::kSetUpWindowAlone},
                                          {"`creep=90`, window", "creep:*=90", Also::kWindowAlone},
                                          {"`creep=5`, model", "creep:*=5"},
                                          {"`lag`, model", "lag:*=500"},
                                          {"`spike=10`", "spike:*=10", Also::kNothing},
                                          {"`frozen`", "frozen:*", Also::kNothing},
                                          {"`creep=600`", "creep:*=600", Also::kNothing},
                                          {"nothing", ""},
                                          {"`deaf=3`", "deaf=3"},
                                          {"`stale=10`", "stale=10"},
                                          {"`doubled`", "doubled"},
                                          {"`swapped`", "swapped"}}};

[[nodiscard]] MachineModel machine_without_bounds() {
  MachineModel model = machine_at_begin();
  for (JointSpec& joint : model.joints) joint.limits.following_error = 1e4;
  return model;
}

/// What the machine file says by default, the drives' model, and times that phases last for.
[[nodiscard]] monitoring::Limits limits_of_phases(const Unseen& unseen) {
  const MachineModel model = machine_at_begin();
  auto limits = config::load_monitoring(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml", model);
  limits.guard_stop_s = 0.05;
  limits.settle_s = 0.1;
  const bool is_window = unseen.also == Also::kSetUpWindowAlone;
  if (is_window || unseen.also == Also::kJointSpeedAlone) limits.set_up_tip_speed = 1e4;
  for (std::size_t i = 0; i < 5; ++i) {
    monitoring::AxisLimits& axis = limits.axes[i];
    if (is_window) {
      axis.standstill = axis.set_up_speed = 1e4;
      axis.set_up_low = axis.set_up_high = model.joints[i].home;
      axis.window_margin = 0.1;
    }
    axis.has_model = unseen.also == Also::kModel;
    axis.time_constant_s = 0.002;  // of the simulated drives
    axis.model_error = i < 3 ? 0.5 : 0.005;
    if (unseen.also != Also::kWindowAlone) continue;
    axis.standstill = 1e4;
    axis.low = axis.set_up_low = model.joints[i].home - 100;
    axis.high = axis.set_up_high = model.joints[i].home + 100;
  }
  return limits;
}

/// What the monitoring finds in `phase`: the letter of its alarm, or a dot.
std::string found_in(const Phase& phase, const Unseen& unseen) {
  SCOPED_TRACE(testing::Message() << unseen.name << " in " << phase.name);
  const drives::HomingPlan homing{.is_referenced = !phase.is_unreferenced};
  auto plant = std::make_unique<Rehearsal>(std::vector<drives::HomingPlan>(5, homing),
                                           machine_without_bounds());
  plant->monitor.emplace(limits_of_phases(unseen), 0.1);
  phase.begin(*plant);
  const State begun = plant->world.now();
  EXPECT_TRUE(begun == State::kFaultStop || plant->world.state.alarm == Alarm::kNone);
  const std::size_t first = plant->world.records.size();
  if (*unseen.injection != '\0') plant->inject(unseen.injection);
  const bool is_fault = plant->until(State::kFault, 3);
  if (phase.tip_at == TipAt::kOnLine) {
    EXPECT_LE(plant->deviation(first), 1e-9) << "mm off the path";
  }
  const Alarm alarm = plant->world.state.alarm;
  if (!is_fault) {  // to mend is a jump of the reports
    plant->monitor.reset();
    plant->world.in.monitoring = {};
  }
  plant->wait(0.5);  // drives that move in Fault are an alarm of their own
  expect_recovery(*plant);
  return is_fault ? letter_of(alarm) : "·";
}

TEST(MonitoringPhases, FindsNothingWhereAHomingIsBrokenOffByTheOperatorOrAFault) {
  for (const char* const end : {"abort", "emergency"}) {
    SCOPED_TRACE(end);
    const drives::HomingPlan homing{.is_referenced = false};
    auto plant = std::make_unique<Rehearsal>(std::vector<drives::HomingPlan>(5, homing),
                                             machine_without_bounds());
    plant->monitor.emplace(limits_of_phases({"model", ""}), 0.1);
    plant->world.in.session = 0;
    ASSERT_TRUE(plant->enable());
    plant->say(Verb::kHome);
    plant->wait(0.1);
    ASSERT_EQ(plant->world.now(), State::kHoming);
    if (*end == 'a') {
      plant->say(Verb::kAbort);
    } else {
      plant->inject(end);
    }
    for (int n = 0; n < 1500; ++n) {
      plant->cycle();
      ASSERT_EQ(plant->world.in.monitoring.alarm, Alarm::kNone)
          << static_cast<int>(plant->world.in.monitoring.alarm) << " in state "
          << static_cast<int>(plant->world.now()) << ", cycle " << n;
    }
  }
}

TEST(MonitoringPhases, CallADriveThatHomesHomingWhateverTheStateSays) {
  using interpolator::motion_of;
  EXPECT_EQ(motion_of(State::kAborting, false, true), monitoring::Motion::kHoming);
  EXPECT_EQ(motion_of(State::kFaultStop, false, true), monitoring::Motion::kHoming);
  EXPECT_EQ(motion_of(State::kAborting, false, false), monitoring::Motion::kProgram);
  EXPECT_EQ(motion_of(State::kReady, false, true), monitoring::Motion::kRest) << "whoever says so";
  EXPECT_EQ(motion_of(State::kHoming, true, true), monitoring::Motion::kOff) << "a dry run";
}

std::string what_is_found_in_phases() {
  std::ostringstream text;
  text << "| |";
  for (const Unseen& unseen : kUnseen) text << ' ' << unseen.name << " |";
  text << "\n|---|";
  for (std::size_t i = 0; i < kUnseen.size(); ++i) text << "---|";
  for (const Phase& phase : kMachinePhases) {
    text << "\n| " << phase.name << " |";
    for (const Unseen& unseen : kUnseen) text << ' ' << found_in(phase, unseen) << " |";
  }
  text << '\n';
  return text.str();
}

TEST(MonitoringPhases, EndAsTheDocumentSaysWithTheConstantBoundsWideOpen) {
  if (!kIsTimed) {  // a sanitizer sees the same code in some of the pairs
    for (std::size_t n = 0; n < kUnseen.size() * kMachinePhases.size(); n += 17) {
      (void)found_in(kMachinePhases[n % kMachinePhases.size()], kUnseen[n % kUnseen.size()]);
    }
    return;
  }
  expect_table_of_document(MERIDIAN_SOURCE_DIR "/docs/monitoring.md", "monitoring",
                           what_is_found_in_phases());
}

}  // namespace
}  // namespace meridian::test
