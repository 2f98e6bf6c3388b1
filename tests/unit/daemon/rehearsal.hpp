// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/jog/homing.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/daemon/listeners/feedback_merge.hpp"
#include "service/daemon/monitoring/cycle_monitor.hpp"
#include "service/daemon/monitoring/set_up_jog.hpp"
#include "service/daemon/ports/drive_words.hpp"
#include "service/drives/simulated/drive_group.hpp"
#include "support/cycle_world.hpp"
#include "support/machines.hpp"
#include "support/made_plan.hpp"

namespace meridian::test {

inline const ToolPose kRehearsalBegin{{0, 0, 0}, {std::sin(0.3), 0, std::cos(0.3)}};
inline const PathLimits kRehearsalLimits{100, 1500, 30000};

[[nodiscard]] inline MachineModel machine_at_begin() {
  MachineModel model = lai_machine();
  const JointVector at = solve(model, model.tool_length_mm, kRehearsalBegin, 0, {}).q;
  for (std::size_t i = 0; i < 5; ++i) model.joints[i].home = at[i];
  return model;
}

/// Cycle, drives and what joins them, in one process and in step: no wire and no clock.
struct Rehearsal {
  explicit Rehearsal(const std::vector<drives::HomingPlan>& homing = {},
                     const MachineModel& machine = machine_at_begin())
      : model(machine), group(model, {}, homing) {
    world.are_drives_alive = false;  // these are
    report();
  }

  void cycle() {
    if (monitor) {
      watch_guard();
      world.in.monitoring =
          monitor->check(model, world.in, world.out.record, world.state.is_dry_run,
                         asked_of(world.state.homing).mode_mask);
    }
    const CycleRecord& record = world.run();
    dds::SetpointSample setpoint;
    setpoint.setpoint = record.setpoint;
    setpoint.crc = dds::setpoint_crc(record.setpoint, kService);
    group.take(setpoint, kParticipant);
    for (std::uint8_t i = 0; i < 5; ++i) group.take(command_of(i, record.state), kParticipant);
    group.work(1);
    report();
  }
  [[nodiscard]] bool until(State wanted, double seconds) {
    for (double t = 0; t < seconds && world.now() != wanted; t += world.dt()) cycle();
    return world.now() == wanted;
  }
  void wait(double seconds) {
    for (double t = 0; t < seconds; t += world.dt()) cycle();
  }
  void say(Verb verb, double argument = 0) {
    world.in.has_command = true;
    world.in.command = {++world.request, verb, argument};
    cycle();
  }
  [[nodiscard]] bool enable() {
    cycle();
    say(Verb::kEnable);
    return until(State::kReady, 1);
  }
  /// Starts what was planned since Ready, and runs `seconds` of it.
  void run(double seconds, double argument = 0) {
    ASSERT_TRUE(until(State::kLoaded, 1));
    say(Verb::kStart, argument);
    wait(seconds);
  }
  /// The machine cuts 200 mm along x at 100 mm/s, and has done so for a while.
  void start() {
    ASSERT_TRUE(enable());
    plan.cut({200, 0, 0}, kRehearsalLimits);
    ASSERT_NO_FATAL_FAILURE(run(0.5));
    ASSERT_EQ(world.now(), State::kRunning);
  }
  /// Orders of the hand that said `jog` last.
  void jog(int joint, double velocity, double seconds) {
    for (double t = 0; t < seconds; t += 0.02) {
      world.in.jog = {.sample = world.in.jog.sample + 1,
                      .epoch = world.state.epoch,
                      .is_tool = false,
                      .joint = static_cast<std::uint8_t>(joint),
                      .velocity = velocity,
                      .distance = 0,
                      .tool_length_mm = model.tool_length_mm,
                      .dead_man_s = 0.1,
                      .hand = world.request};
      wait(0.02);
    }
  }
  /// `text` with the drive that moves fastest for "*".
  void inject(std::string text) {
    const JointVector& v = world.state.velocity;
    const auto fastest = std::max_element(
        v.begin(), v.begin() + 3, [](double a, double b) { return std::abs(a) < std::abs(b); });
    if (const std::size_t star = text.find('*'); star != std::string::npos) {
      text.replace(star, 1, model.joints[static_cast<std::size_t>(fastest - v.begin())].name);
    }
    const auto injection = drives::parse_injection(text, model);
    ASSERT_TRUE(injection.has_value()) << injection.error();
    injected = injection->drive;
    group.inject_now(*injection);
  }
  /// Everything that was injected is mended, and drives in fault are reset.
  void mend() {
    wait(0.3);
    inject("mend");
    is_resetting = true;
    wait(0.2);
    is_resetting = false;
  }
  /// Largest distance of the tip that drives are to follow from the programmed line, mm.
  [[nodiscard]] double deviation(std::size_t first) const {
    double worst = 0;
    for (std::size_t n = first; n < world.records.size(); ++n) {
      if ((world.records[n].setpoint.flags & kSetpointEnabled) == 0) continue;
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
  [[nodiscard]] bool do_drives_stand() const {
    for (int i = 0; i < group.size(); ++i) {
      if (group.drive(i).velocity() != 0) return false;
    }
    return true;
  }

  MachineModel model;
  CycleWorld world{model};
  MadePlan plan{model, *world.port, kRehearsalBegin};
  drives::DriveGroup group;
  interpolator::FeedbackMerge merge;
  std::optional<interpolator::CycleMonitor> monitor;  ///< none: nothing is monitored
  ProbeInput probe = ProbeInput::kNone;               ///< what the drives report of it
  bool is_resetting = false;
  bool is_jog_slowed = false;  ///< with an open guard, as the service does
  int injected = 0;

 private:
  static constexpr std::uint64_t kService = 7, kParticipant = 41;
  /// As CycleThread does, but that nobody holds what an open guard forbids.
  void watch_guard() {
    const auto& limits = monitor->monitor().limits();
    world.in.max_jog_speed =
        is_jog_slowed && world.in.feedback.is_guard_open
            ? interpolator::set_up_jog_speed(model, limits, world.state, world.in.tool_length_mm)
            : std::numeric_limits<double>::infinity();
  }
  void report() {
    for (dds::DriveFeedback sample; group.reports(sample);) {
      merge.take(sample, 7, world.in.now_ns);
    }
    world.in.feedback = merge.feedback();
    world.in.feedback.probe = probe;
  }
  [[nodiscard]] dds::DriveCommand command_of(std::uint8_t drive, State state) const {
    const HomingAsked asked = asked_of(world.state.homing);
    const interpolator::DriveWords& words = merge.words();
    const interpolator::DriveOrder next = interpolator::next_order(
        (words.joint_mask >> drive & 1U) != 0, words.statusword[drive],
        {.is_enabled = is_enabled(state),
         .work = interpolator::drive_work(asked.mode_mask, asked.start_mask, drive),
         .is_reset = is_resetting});
    dds::DriveCommand command;
    command.drive = drive;
    command.service_id = kService;
    command.controlword = next.controlword;
    command.mode = next.mode;
    return command;
  }
};

}  // namespace meridian::test
