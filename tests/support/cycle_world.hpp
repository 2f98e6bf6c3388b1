// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "meridian/cycle/step.hpp"
#include "meridian/planner/motion_port.hpp"

namespace meridian::test {

/// step() with drives that follow at once and a clock that never slips: calls it cycle by cycle and
/// keeps every record and event. Tests change `in` before a cycle to provoke what they like.
class CycleWorld {
 public:
  explicit CycleWorld(const MachineModel& model, const JointVector& at = {})
      : machine(model),
        port(std::make_unique<MotionPort>()),
        reader(*port),
        state({}, rate_bounds(model)) {
    in.feedback.position = drives_of(model, at);
    in.feedback.joint_mask = all_joints(machine);
    in.feedback.referenced_mask = all_joints(machine);
    in.session = 1;
  }

  /// One cycle, `lost` periods after the last one.
  const CycleRecord& run(std::uint32_t lost = 0) {
    in.cycle += 1 + lost;
    in.lost_periods = lost;
    in.due_ns = static_cast<std::int64_t>(in.cycle) * machine.cycle_ns;
    in.now_ns = in.due_ns;
    if (are_drives_alive) in.feedback.arrival_ns = in.now_ns;
    if (are_drives_alive && in.feedback.emergency_stop) in.feedback.emergency_ns = in.now_ns;
    step(machine, state, reader, in, out);
    in.has_command = false;
    in.action = {};
    if (are_drives_alive) follow();
    records.push_back(out.record);
    for (std::size_t i = 0; i < out.event_count; ++i) events.push_back(out.events[i]);
    return records.back();
  }

  /// One cycle that brings a verb.
  const CycleRecord& command(Verb verb, double argument = 0) {
    in.has_command = true;
    in.command = {++request, verb, argument};
    return run();
  }

  /// Cycles until `state` is reached; false after `seconds`.
  [[nodiscard]] bool run_until(State wanted, double seconds = 60) {
    for (double t = 0; t < seconds; t += dt()) {
      if (state.state == wanted) return true;
      run();
    }
    return state.state == wanted;
  }
  void run_for(double seconds) {
    for (double t = 0; t < seconds; t += dt()) run();
  }
  /// Off to Ready.
  [[nodiscard]] bool enable() {
    run();
    command(Verb::kEnable);
    return run_until(State::kReady, 1);
  }
  /// From Off to the program's first motion.
  [[nodiscard]] bool start() {
    if (!enable() || !run_until(State::kLoaded, 1)) return false;
    command(Verb::kStart);
    return true;
  }

  [[nodiscard]] double dt() const { return static_cast<double>(machine.cycle_ns) * 1e-9; }
  [[nodiscard]] State now() const { return state.state; }
  /// The last event with that code, or one with `code` and nothing else.
  [[nodiscard]] Event last(EventCode code) const {
    for (auto e = events.rbegin(); e != events.rend(); ++e) {
      if (e->code == code) return *e;
    }
    return {};
  }
  [[nodiscard]] int count(EventCode code) const {
    int n = 0;
    for (const Event& e : events) n += e.code == code;
    return n;
  }
  /// Every state in the order in which it was entered.
  [[nodiscard]] std::vector<State> states() const {
    std::vector<State> out_states{State::kOff};
    for (const Event& e : events) {
      if (e.code == EventCode::kStateChanged) out_states.push_back(static_cast<State>(e.a));
    }
    return out_states;
  }

  MachineModel machine;
  std::unique_ptr<MotionPort> port;
  MotionReader reader;
  CycleState state;
  CycleInputs in;
  StepOutput out;
  bool are_drives_alive = true;
  std::uint64_t request = 0;
  std::vector<CycleRecord> records;
  std::vector<Event> events;

 private:
  void follow() {
    const Setpoint& setpoint = out.record.setpoint;
    const bool is_on = (setpoint.flags & kSetpointEnabled) != 0;
    in.feedback.enabled_mask = is_on ? all_joints(machine) : 0;
    in.feedback.cycle_seen = setpoint.cycle;
    if (is_on) in.feedback.position = setpoint.position;
  }
};

}  // namespace meridian::test
