// SPDX-License-Identifier: Apache-2.0
#include "service/drives/drive_group.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "meridian/kinematics/limited.hpp"

namespace meridian::drives {
DriveGroup::DriveGroup(const MachineModel& model, const ServoLag& lag,
                       const std::vector<HomingPlan>& homing)
    : cycle_s_(static_cast<double>(model.cycle_ns) * 1e-9),
      bridge_cycles_(model.bridge_cycles),
      own_bridge_cycles_(model.bridge_cycles) {
  for (int i = 0; i < model.joint_count; ++i) {
    const auto place = static_cast<std::size_t>(i);
    drives_.emplace_back(drive_spec(model, i), lag,
                         place < homing.size() ? homing[place] : HomingPlan{});
  }
}

bool DriveGroup::is_off() const noexcept {
  return std::all_of(drives_.begin(), drives_.end(), [](const Drive& drive) {
    return drive.state() == DriveState::kSwitchOnDisabled ||
           drive.state() == DriveState::kReadyToSwitchOn || drive.state() == DriveState::kFault;
  });
}

Drop DriveGroup::take(const dds::DriveCommand& command, std::uint64_t sender) noexcept {
  const Master from{sender, command.service_id};
  const Master before = pin_.master();
  Drop drop = Drop::kNone;
  if (command.service_id == 0 || command.drive >= drives_.size()) {
    drop = Drop::kImplausible;
  } else if (!pin_.obeys(from)) {
    drop = Drop::kForeignCommand;
  }
  dropped_.count(drop);
  if (drop != Drop::kNone) return drop;
  if (before != from) obey_new_master();
  if (!is_dead_) drives_[command.drive].take_controlword(command.controlword, command.mode);
  return drop;
}

void DriveGroup::obey_new_master() noexcept {
  has_setpoint_ = is_new_ = false;
  age_ = {};
  bridge_cycles_ = own_bridge_cycles_;
  for (const Bridge& bridge : bridges_) {
    if (bridge.by == pin_.master()) bridge_cycles_ = bridge.cycles;
  }
}

void DriveGroup::see_master(bool is_there) noexcept { pin_.work(is_there, is_off()); }

void DriveGroup::take(const dds::MachineInfo& machine, std::uint64_t sender) noexcept {
  if (!machine.is_serving || sender == 0) return;
  const Bridge bridge{{sender, machine.service_id}, static_cast<int>(machine.bridge_cycles)};
  // A service says it when it comes, which may be before the last master is gone.
  const auto known = std::find_if(bridges_.begin(), bridges_.end(), [sender](const Bridge& one) {
    return one.by.participant == sender;
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

Drop DriveGroup::take(const dds::SetpointSample& setpoint, std::uint64_t sender,
                      std::int64_t arrival_ns) noexcept {
  const Drop drop = check(setpoint, sender, arrival_ns);
  dropped_.count(drop);
  if (drop != Drop::kNone) return drop;
  if ((setpoint.setpoint.flags & kSetpointDry) != 0) return drop;
  if (is_dead_ || !setpoint_faults_.lets_pass(setpoint)) return drop;
  return accept(setpoint);
}

Drop DriveGroup::check(const dds::SetpointSample& setpoint, std::uint64_t sender,
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

Drop DriveGroup::accept(const dds::SetpointSample& setpoint) noexcept {
  if (has_setpoint_ && setpoint.setpoint.cycle <= newest_.setpoint.cycle) {
    dropped_.count(Drop::kOutOfOrder);
    return Drop::kOutOfOrder;
  }
  newest_ = setpoint;
  has_setpoint_ = is_new_ = true;
  ++setpoints_seen_;
  return Drop::kNone;
}

/// Between the setpoint that the drives worked with last and the newest: by the sender's cycles,
/// and no longer than this side's own periods allow.
double DriveGroup::elapsed_s() const noexcept {
  constexpr std::int64_t kSlack = 2;  // periods of two clocks
  const std::uint64_t cycles = newest_.setpoint.cycle - followed_cycle_;
  const auto most = static_cast<std::uint64_t>(periods_since_ + bridge_cycles_ + kSlack);
  return cycle_s_ * static_cast<double>(std::min(cycles, most));
}

void DriveGroup::work(int periods) noexcept {
  report_wire_.work(periods);
  has_reported_ = false;
  if (is_dead_) return;
  const double dt_s = cycle_s_ * periods;
  setpoint_faults_.work(periods);
  for (dds::SetpointSample late; setpoint_faults_.arrives(late);) static_cast<void>(accept(late));
  // Who slept through a setpoint did not miss it: periods that this side lost count from the next
  // one on, when a service that the same host held up has sent again.
  periods_without_ = is_new_ ? 0 : periods_without_ + periods_slept_ + 1;
  periods_slept_ = is_new_ ? 0 : periods - 1;
  // However long this side slept, the sent velocity leads on no farther than the bridge.
  if (is_new_) bridge_left_ = bridge_cycles_;
  const int bridged = is_new_ ? 0 : std::min(periods, bridge_left_);
  bridge_left_ -= bridged;
  if (!is_new_ && !is_off()) periods_bridged_ += static_cast<std::uint64_t>(periods);
  periods_since_ += periods;
  const bool is_enabled = (newest_.setpoint.flags & kSetpointEnabled) != 0;
  const bool is_fault_stop = (newest_.setpoint.flags & kSetpointFaultStop) != 0;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].work({.is_new = is_new_,
                     .is_enabled = is_enabled,
                     .is_fault_stop = is_fault_stop,
                     .position = newest_.setpoint.position[i],
                     .velocity = newest_.setpoint.velocity[i],
                     .elapsed_s = elapsed_s(),
                     .periods_without = periods_without_,
                     .bridge_cycles = bridge_cycles_,
                     .bridged_s = cycle_s_ * bridged},
                    dt_s);
  }
  if (is_new_) {
    followed_cycle_ = newest_.setpoint.cycle;
    periods_since_ = 0;
  }
  is_new_ = false;
  work_on_injections(dt_s);
}

void DriveGroup::work_on_injections(double dt_s) noexcept {
  const bool is_enabled = std::all_of(drives_.begin(), drives_.end(), [](const Drive& drive) {
    return drive.state() == DriveState::kOperationEnabled;
  });
  if (!is_enabled) return;
  enabled_s_ += dt_s;
  std::erase_if(injections_, [this](const Injection& injection) {
    if (enabled_s_ < injection.after_s) return false;
    inject_now(injection);
    return true;
  });
}

void DriveGroup::inject_now(const Injection& injection) noexcept {
  const auto i = static_cast<std::size_t>(
      std::clamp(injection.drive, 0, static_cast<int>(drives_.size()) - 1));
  Drive& drive = drives_[i];
  switch (injection.kind) {
    case Injection::Kind::kFault:
      return drive.fail(kErrorDevice);
    case Injection::Kind::kBlocked:
      return drive.block_shaft(true);
    case Injection::Kind::kUnpowered:
      return drive.set_power(false);
    case Injection::Kind::kLag:
      return drive.set_time_constant(injection.value);
    case Injection::Kind::kSilence:
      is_silent_ = true;
      return;
    case Injection::Kind::kDead:
      is_dead_ = true;
      return;
    case Injection::Kind::kEmergency:
      is_emergency_stop_ = true;
      return;
    case Injection::Kind::kUnreferenced:
      return report_faults_.lose_reference(i);
    case Injection::Kind::kMute:
      return report_faults_.mute(i);
    case Injection::Kind::kFrozen:
      return report_faults_.freeze(i, drive.position());
    case Injection::Kind::kNoNumber:
      return report_faults_.make_no_number(i);
    case Injection::Kind::kSpike:
      return report_faults_.add_once(i, injection.value);
    case Injection::Kind::kDeaf:
      return setpoint_faults_.deafen(injection.value);
    case Injection::Kind::kLate:
      return setpoint_faults_.delay(injection.value);
    case Injection::Kind::kUntold:
      return report_faults_.leave_out_cycle();
    case Injection::Kind::kStale:
      return report_wire_.delay(injection.value);
    case Injection::Kind::kDoubled:
      return report_wire_.send_twice();
    case Injection::Kind::kSwapped:
      return report_wire_.swap_neighbours();
    case Injection::Kind::kMend:
      return mend();
  }
}

void DriveGroup::mend() noexcept {
  for (Drive& drive : drives_) {
    drive.block_shaft(false);
    drive.set_power(true);
    drive.set_time_constant(std::nullopt);
  }
  is_silent_ = is_dead_ = is_emergency_stop_ = false;
  report_faults_ = {};
  report_wire_ = {};
  setpoint_faults_ = {};
}

bool DriveGroup::reports(dds::DriveFeedback& report) {
  if (is_silent()) return false;
  if (!std::exchange(has_reported_, true)) report_wire_.put(feedback());
  return report_wire_.arrives(report);
}

dds::DriveFeedback DriveGroup::feedback() noexcept {
  dds::DriveFeedback feedback;
  feedback.joint_mask = (1U << drives_.size()) - 1;
  feedback.sample = ++sample_;
  feedback.cycle_seen = has_setpoint_ ? newest_.setpoint.cycle : 0;
  feedback.service_id = pin_.master().service_id;
  feedback.is_emergency_stop = is_emergency_stop_;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    feedback.position[i] = drives_[i].position();
    feedback.statusword[i] = drives_[i].statusword();
    feedback.error[i] = drives_[i].error();
    feedback.mode_display[i] = drives_[i].mode();
    if (drives_[i].is_referenced()) feedback.referenced_mask |= 1U << i;
  }
  report_faults_.apply(feedback);
  return feedback;
}

}  // namespace meridian::drives
