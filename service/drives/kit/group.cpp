// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/group.hpp"

#include <algorithm>
#include <cmath>

namespace meridian::drive {

namespace {

constexpr std::int64_t kSlack = 2;  // periods of two clocks

}  // namespace

static_assert(static_cast<int>(Probe::kFree) == static_cast<int>(ProbeInput::kFree) &&
              static_cast<int>(Probe::kContact) == static_cast<int>(ProbeInput::kContact));

Group::Group(const GroupSpec& spec)
    : number_(spec.number),
      machine_joints_(spec.joints),
      cycle_s_(static_cast<double>(spec.cycle_ns) * 1e-9),
      bridge_cycles_(spec.bridge_cycles),
      own_bridge_cycles_(spec.bridge_cycles) {
  axis_of_.fill(-1);
  for (const GroupAxis& axis : spec.axes) {
    const auto joint = static_cast<std::size_t>(axis.joint);
    axis_of_[joint] = size();
    joint_mask_ |= 1U << joint;
    joints_.push_back(joint);
    axes_.emplace_back(axis.spec, axis.homing, axis.position);
    machine_joints_ = std::max(machine_joints_, axis.joint + 1);
  }
}

bool Group::is_off() const noexcept {
  return std::all_of(axes_.begin(), axes_.end(), [](const FollowingAxis& axis) {
    return axis.state() == DriveState::kSwitchOnDisabled ||
           axis.state() == DriveState::kReadyToSwitchOn || axis.state() == DriveState::kFault;
  });
}

Drop Group::take(const dds::DriveCommand& command, std::uint64_t sender) noexcept {
  const Drop drop = admit(command, sender);
  if (drop == Drop::kNone) apply(command);
  return drop;
}

Drop Group::admit(const dds::DriveCommand& command, std::uint64_t sender) noexcept {
  const Master from{sender, command.service_id};
  const Master before = pin_.master();
  Drop drop = Drop::kNone;
  if (command.service_id == 0 || command.drive >= machine_joints_) {
    drop = Drop::kImplausible;
  } else if (!pin_.obeys(from)) {
    drop = Drop::kForeignCommand;
  }
  dropped_.count(drop);
  if (drop == Drop::kNone && before != from) obey_new_master();
  return drop;
}

void Group::apply(const dds::DriveCommand& command) noexcept {
  const int axis = command.drive < axis_of_.size() ? axis_of_[command.drive] : -1;
  if (axis < 0) return;
  axes_[static_cast<std::size_t>(axis)].take_controlword(command.controlword, command.mode);
}

void Group::obey_new_master() noexcept {
  has_setpoint_ = is_new_ = false;
  age_ = {};
  reached_cycle_ = 0;
  bridge_cycles_ = own_bridge_cycles_;
  for (const Bridge& bridge : bridges_) {
    if (bridge.by == pin_.master()) bridge_cycles_ = bridge.cycles;
  }
}

void Group::see_master(bool is_there) noexcept { pin_.work(is_there, is_off()); }

void Group::take(const Bridge& bridge) noexcept {
  // A service says it when it comes, which may be before the last master is gone.
  const auto known = std::find_if(bridges_.begin(), bridges_.end(), [&](const Bridge& one) {
    return one.by.participant == bridge.by.participant;
  });
  if (known != bridges_.end()) {
    *known = bridge;
  } else {
    bridges_[next_bridge_++ % bridges_.size()] = bridge;
  }
  if (pin_.state() != MasterPin::State::kFree && bridge.by == pin_.master()) {
    bridge_cycles_ = bridge.cycles;
  }
}

Drop Group::take(const dds::SetpointSample& setpoint, std::uint64_t sender,
                 std::int64_t arrival_ns) noexcept {
  const Drop drop = admit(setpoint, sender, arrival_ns);
  if (drop != Drop::kNone || (setpoint.setpoint.flags & kSetpointDry) != 0) return drop;
  return accept(setpoint);
}

Drop Group::admit(const dds::SetpointSample& setpoint, std::uint64_t sender,
                  std::int64_t arrival_ns) noexcept {
  const Drop drop = check(setpoint, sender, arrival_ns);
  dropped_.count(drop);
  return drop;
}

Drop Group::check(const dds::SetpointSample& setpoint, std::uint64_t sender,
                  std::int64_t arrival_ns) noexcept {
  if (pin_.state() == MasterPin::State::kFree) return Drop::kNoMaster;
  if (!pin_.is_master(sender)) return Drop::kForeignSetpoint;
  if (setpoint.crc != dds::setpoint_crc(setpoint.setpoint, pin_.master().service_id)) {
    return Drop::kChecksum;
  }
  if (arrival_ns == 0) return Drop::kNone;
  const auto longest_ns = static_cast<std::int64_t>(1e9 * cycle_s_ * (bridge_cycles_ + 1));
  const bool is_late = age_.is_late(setpoint.setpoint.due_ns, arrival_ns, longest_ns, is_off());
  return is_late ? Drop::kStale : Drop::kNone;
}

Drop Group::accept(const dds::SetpointSample& setpoint) noexcept {
  if (has_setpoint_ && setpoint.setpoint.cycle <= newest_.setpoint.cycle) {
    dropped_.count(Drop::kOutOfOrder);
    return Drop::kOutOfOrder;
  }
  newest_ = setpoint;
  has_setpoint_ = is_new_ = true;
  ++setpoints_seen_;
  return Drop::kNone;
}

/// So many cycles of the sender, and no longer than this side's own periods allow.
double Group::capped_s(std::uint64_t cycles) const noexcept {
  const auto max = static_cast<std::uint64_t>(periods_since_ + bridge_cycles_ + kSlack);
  return cycle_s_ * static_cast<double>(std::min(cycles, max));
}

/// Between the setpoint that the drives worked with last and the newest, by the sender's cycles.
double Group::elapsed_s() const noexcept {
  return capped_s(newest_.setpoint.cycle - followed_cycle_);
}

/// How far this period leads on by the sender's cycles: not at all where the bridge has led there
/// already. Own periods count where no setpoint leads.
double Group::advance_s(int periods) noexcept {
  const std::uint64_t before = reached_cycle_;
  const bool is_bridged = !is_new_ && periods_without_ <= bridge_cycles_;
  const auto led_on = static_cast<std::uint64_t>(is_bridged ? bridged(periods) : 0);
  reached_cycle_ = is_new_ ? std::max(before, newest_.setpoint.cycle) : before + led_on;
  const bool is_led = before != 0 && (is_new_ || (is_bridged && periods <= bridge_cycles_));
  if (!is_led || is_off()) return cycle_s_ * periods;
  return capped_s(reached_cycle_ - before);
}

AxisInput Group::input_of(std::size_t joint, int periods) const noexcept {
  return {.is_new = is_new_,
          .is_enabled = (newest_.setpoint.flags & kSetpointEnabled) != 0,
          .is_fault_stop = (newest_.setpoint.flags & kSetpointFaultStop) != 0,
          .position = newest_.setpoint.position[joint],
          .velocity = newest_.setpoint.velocity[joint],
          .elapsed_s = elapsed_s(),
          .periods_without = periods_without_,
          .bridge_cycles = bridge_cycles_,
          .bridged_s = is_new_ ? 0 : cycle_s_ * bridged(periods),
          .slept_s = cycle_s_ * bridged(periods - 1),
          .bridge_s = cycle_s_ * bridge_cycles_};
}

void Group::work(int periods, Hardware& hardware) noexcept {
  const double dt_s = cycle_s_ * periods;
  // Who slept through a setpoint did not miss it: periods that this side lost count from the next
  // one on, when a service that the same host held up has sent again.
  periods_without_ = is_new_ ? 0 : periods_without_ + periods_slept_ + 1;
  periods_slept_ = is_new_ ? 0 : periods - 1;
  if (!is_new_ && !is_off()) periods_bridged_ += static_cast<std::uint64_t>(periods);
  periods_since_ += periods;
  const double advance = advance_s(periods);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const int axis = static_cast<int>(i);
    Output output = axes_[i].lead(input_of(joints_[i], periods), dt_s, axis, hardware);
    output.elapsed_s = advance;
    hardware.write(axis, output);
  }
  if (is_new_) {
    followed_cycle_ = newest_.setpoint.cycle;
    periods_since_ = 0;
  }
  is_new_ = false;
  hardware.exchange(dt_s);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].see(hardware.read(static_cast<int>(i)), dt_s);
  }
  see_inputs(hardware);
}

void Group::see_inputs(Hardware& hardware) noexcept {
  is_emergency_stop_ = hardware.is_emergency_stop();
  is_guard_open_ = hardware.is_guard_open();
  probe_ = static_cast<ProbeInput>(hardware.probe());
}

void Group::see(Hardware& hardware) noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].see(hardware.read(static_cast<int>(i)), 0);
  }
  see_inputs(hardware);
}

dds::DriveFeedback Group::feedback() noexcept {
  dds::DriveFeedback feedback;
  feedback.drive_group = number_;
  feedback.joint_mask = joint_mask_;
  feedback.sample = ++sample_;
  feedback.cycle_seen = has_setpoint_ ? newest_.setpoint.cycle : 0;
  feedback.service_id = pin_.master().service_id;
  feedback.is_emergency_stop = is_emergency_stop_;
  feedback.is_guard_open = is_guard_open_;
  feedback.probe = probe_;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const FollowingAxis& axis = axes_[i];
    const std::size_t joint = joints_[i];
    feedback.position[joint] = axis.position();
    feedback.statusword[joint] = axis.statusword();
    feedback.error[joint] = axis.error();
    feedback.mode_display[joint] = axis.mode();
    if (axis.is_referenced()) feedback.referenced_mask |= 1U << joint;
  }
  return feedback;
}

}  // namespace meridian::drive
