// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/drive_group.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "meridian/kinematics/limited.hpp"

namespace meridian::drives {

using drive::Drop;

namespace {

[[nodiscard]] HomingPlan plan_of(const std::vector<HomingPlan>& plans, int drive) {
  const auto index = static_cast<std::size_t>(drive);
  return index < plans.size() ? plans[index] : HomingPlan{};
}

[[nodiscard]] SimulatedServos servos_of(const MachineModel& model, const ServoLag& lag,
                                        const std::vector<HomingPlan>& plans) {
  SimulatedServos servos(lag);
  for (int i = 0; i < model.joint_count; ++i) servos.add(drive_spec(model, i), plan_of(plans, i));
  return servos;
}

[[nodiscard]] drive::GroupSpec group_of(const MachineModel& model, SimulatedServos& servos,
                                        const std::vector<HomingPlan>& plans) {
  drive::GroupSpec spec;
  spec.joints = model.joint_count;
  spec.cycle_ns = model.cycle_ns;
  spec.bridge_cycles = model.bridge_cycles;
  for (int i = 0; i < model.joint_count; ++i) {
    const double stands = servos.servo(static_cast<std::size_t>(i)).servo.position;
    spec.axes.push_back({drive_spec(model, i), homing_of(plan_of(plans, i)), i, stands});
  }
  return spec;
}

}  // namespace

DriveGroup::DriveGroup(const MachineModel& model, const ServoLag& lag,
                       const std::vector<HomingPlan>& homing)
    : servos_(servos_of(model, lag, homing)), group_(group_of(model, servos_, homing)) {}

Drop DriveGroup::take(const dds::DriveCommand& command, std::uint64_t sender) noexcept {
  const Drop drop = group_.admit(command, sender);
  if (drop == Drop::kNone && !is_dead_) group_.apply(command);
  return drop;
}

Drop DriveGroup::take(const dds::SetpointSample& setpoint, std::uint64_t sender,
                      std::int64_t arrival_ns) noexcept {
  const Drop drop = group_.admit(setpoint, sender, arrival_ns);
  if (drop != Drop::kNone || (setpoint.setpoint.flags & kSetpointDry) != 0) return drop;
  if (is_dead_ || !setpoint_faults_.lets_pass(setpoint)) return drop;
  return group_.accept(setpoint);
}

void DriveGroup::work(int periods) noexcept {
  report_wire_.work(periods);
  has_reported_ = false;
  if (is_dead_) return;
  setpoint_faults_.work(periods);
  for (dds::SetpointSample late; setpoint_faults_.arrives(late);) (void)group_.accept(late);
  group_.work(periods, servos_);
  work_on_injections(group_.cycle_s() * periods);
}

void DriveGroup::work_on_injections(double dt_s) noexcept {
  for (int i = 0; i < size(); ++i) {
    if (drive(i).state() != DriveState::kOperationEnabled) return;
  }
  enabled_s_ += dt_s;
  std::erase_if(injections_, [this](const Injection& injection) {
    if (enabled_s_ < injection.after_s) return false;
    inject_now(injection);
    return true;
  });
}

void DriveGroup::inject_now(const Injection& injection) noexcept {
  const auto i = static_cast<std::size_t>(std::clamp(injection.drive, 0, size() - 1));
  SimulatedServo& servo = servos_.servo(i);
  drive::FollowingAxis& axis = group_.axis(static_cast<int>(i));
  switch (injection.kind) {
    case Injection::Kind::kFault:
      return axis.fail(drive::kErrorDevice);
    case Injection::Kind::kBlocked:
      servo.is_blocked = true;
      return;
    case Injection::Kind::kUnpowered:
      servo.has_power = false;
      return axis.set_power(false);
    case Injection::Kind::kLag:
      servo.sick_time_constant_s = injection.value;
      return;
    case Injection::Kind::kSilence:
      is_silent_ = true;
      return;
    case Injection::Kind::kDead:
      is_dead_ = true;
      return;
    case Injection::Kind::kEmergency:
      is_emergency_stop_ = true;
      return;
    case Injection::Kind::kGuard:
      is_guard_open_ = true;
      return;
    case Injection::Kind::kCreep:
      return report_faults_.creep(i, injection.value * group_.cycle_s());
    case Injection::Kind::kUnreferenced:
      return report_faults_.lose_reference(i);
    case Injection::Kind::kMute:
      return report_faults_.mute(i);
    case Injection::Kind::kFrozen:
      return report_faults_.freeze(i, axis.position());
    case Injection::Kind::kNoNumber:
      return report_faults_.make_no_number(i);
    case Injection::Kind::kSpike:
      return report_faults_.add_once(i, injection.value);
    case Injection::Kind::kDeaf:
      return setpoint_faults_.deafen(injection.value);
    case Injection::Kind::kLate:
      return setpoint_faults_.delay(injection.value);
    case Injection::Kind::kUnreported:
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
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    SimulatedServo& servo = servos_.servo(i);
    servo.is_blocked = false;
    servo.has_power = true;
    servo.sick_time_constant_s = std::nullopt;
    group_.axis(static_cast<int>(i)).set_power(true);
  }
  is_silent_ = is_dead_ = is_emergency_stop_ = is_guard_open_ = false;
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
  dds::DriveFeedback feedback = group_.feedback();
  feedback.is_emergency_stop = is_emergency_stop_;
  feedback.is_guard_open = is_guard_open_;
  report_faults_.apply(feedback);
  return feedback;
}

}  // namespace meridian::drives
