// SPDX-License-Identifier: Apache-2.0
#include "service/drives/drive_group.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "meridian/kinematics/limited.hpp"

namespace meridian::drives {
namespace {

/// What no drive is ever told, mm or rad and per second: beyond it sums of setpoints lose meaning.
constexpr double kBeyondAnything = 1e9;

[[nodiscard]] bool is_sane(double value) noexcept {
  return std::abs(value) < kBeyondAnything;  // false for what is no number
}

}  // namespace

DriveGroup::DriveGroup(const MachineModel& model, const ServoLag& lag,
                       const std::vector<HomingPlan>& homing)
    : cycle_s_(static_cast<double>(model.cycle_ns) * 1e-9), bridge_cycles_(model.bridge_cycles) {
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

void DriveGroup::take(const dds::DriveCommand& command, std::uint64_t sender) noexcept {
  if (command.drive >= drives_.size() || is_dead_) return;
  if (command.service_id != service_id_) {
    if (service_id_ != 0 && !is_off()) return;
    service_id_ = command.service_id;
    has_setpoint_ = false;
    for (const Told& told : told_) {
      if (told.service_id == service_id_) bridge_cycles_ = told.bridge_cycles;
    }
  }
  sender_ = sender;
  drives_[command.drive].take_controlword(command.controlword, command.mode);
}

void DriveGroup::take(const dds::MachineInfo& machine) noexcept {
  if (!machine.is_serving) return;
  const Told told{machine.service_id, static_cast<int>(machine.bridge_cycles)};
  told_[told_at_++ % told_.size()] = told;
  if (service_id_ == 0 || service_id_ == told.service_id) bridge_cycles_ = told.bridge_cycles;
}

bool DriveGroup::take(const dds::SetpointSample& setpoint, std::uint64_t sender) noexcept {
  if (service_id_ != 0 && sender != sender_) {
    ++setpoints_of_others_;
    return false;
  }
  if ((setpoint.setpoint.flags & kSetpointDry) != 0) return true;
  if (!is_dead_ && setpoint_faults_.lets_pass(setpoint)) accept(setpoint);
  return true;
}

void DriveGroup::accept(const dds::SetpointSample& setpoint) noexcept {
  const bool is_sound = std::all_of(drives_.begin(), drives_.end(), [&](const Drive& drive) {
    const auto i = static_cast<std::size_t>(&drive - drives_.data());
    return is_sane(setpoint.setpoint.position[i]) && is_sane(setpoint.setpoint.velocity[i]);
  });
  const bool is_newer = !has_setpoint_ || setpoint.setpoint.cycle > newest_.setpoint.cycle;
  if (!is_sound || (!is_newer && !is_off())) return;
  newest_ = setpoint;
  has_setpoint_ = is_new_ = true;
  ++setpoints_seen_;
}

void DriveGroup::work(int periods) noexcept {
  report_wire_.work(periods);
  has_reported_ = false;
  if (is_dead_) return;
  const double dt_s = cycle_s_ * periods;
  setpoint_faults_.work(periods);
  for (dds::SetpointSample late; setpoint_faults_.arrives(late);) accept(late);
  // Who slept through a setpoint did not miss it: periods that this side lost count from the next
  // one on, when a service that the same host held up has sent again.
  periods_without_ = is_new_ ? 0 : periods_without_ + periods_slept_ + 1;
  periods_slept_ = is_new_ ? 0 : periods - 1;
  // However long this side slept, the sent velocity leads on no farther than the bridge.
  if (is_new_) bridge_left_ = bridge_cycles_;
  const int bridged = is_new_ ? 0 : std::min(periods, bridge_left_);
  bridge_left_ -= bridged;
  if (!is_new_ && !is_off()) periods_bridged_ += static_cast<std::uint64_t>(periods);
  const bool is_enabled = (newest_.setpoint.flags & kSetpointEnabled) != 0;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].work(
        {is_new_, is_enabled, newest_.setpoint.position[i], newest_.setpoint.velocity[i],
         periods_without_, bridge_cycles_, cycle_s_ * bridged},
        dt_s);
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
