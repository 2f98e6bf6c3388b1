// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "service/drives/kit/group.hpp"
#include "service/drives/simulated/check/checked_drives.hpp"
#include "service/drives/simulated/simulated_servos.hpp"

namespace meridian::test {

/// Drives of somebody who has made a mistake, or none, in a wire without delay and without a clock.
class FaultyDrives : public drives::CheckedDrives {
 public:
  /// `lost`: the drives' process loses so many periods once nobody has spoken for a while.
  FaultyDrives(const MachineModel& model, std::string fault, int lost = 0)
      : fault_(std::move(fault)),
        lost_(lost),
        servos_({drives::LagKind::kFirstOrder, 0.002}),
        model_(model) {
    for (int i = 0; i < model.joint_count; ++i) servos_.add(drive_spec(model, i), {});
    group_.emplace(spec());
  }

  void say(drives::Speaker who, const dds::MachineInfo& machine) override {
    if (is("no-bridge")) return;
    if (const auto bridge = drive::bridge_of(machine, number_of(who))) group_->take(*bridge);
  }
  void say(drives::Speaker who, const dds::DriveCommand& command) override;
  void say(drives::Speaker who, const dds::SetpointSample& setpoint) override;
  void end(drives::Speaker who) override {
    if (who != drives::Speaker::kService) return;
    if (is("drops-off-when-alone")) {
      for (int i = 0; i < model_.joint_count; ++i) {
        (void)group_->take({.drive = static_cast<std::uint8_t>(i),
                            .service_id = group_->pin().master().service_id},
                           service_);
      }
    }
    is_service_there_ = false;
  }
  void begin(drives::Speaker who) override {
    if (who != drives::Speaker::kService) return;
    is_service_there_ = is_restarted_ = true;
    service_ = 43;
  }
  void ask(drives::Wish wish) override { is_stop_open_ = wish == drives::Wish::kOpenEmergencyStop; }
  [[nodiscard]] bool period(std::vector<dds::DriveFeedback>& reports) override;
  [[nodiscard]] std::int64_t now_ns() const override { return now_ns_; }

 private:
  [[nodiscard]] bool is(const char* fault) const { return fault_ == fault; }
  [[nodiscard]] std::uint64_t number_of(drives::Speaker who) const {
    return who == drives::Speaker::kService ? service_ : 42;
  }
  [[nodiscard]] bool is_master_there() const {
    const std::uint64_t master = group_->pin().master().participant;
    return master == 42 || (is_service_there_ && master == service_) ||
           is("keeps-a-service-that-is-gone");
  }
  [[nodiscard]] drive::GroupSpec spec();
  [[nodiscard]] dds::DriveFeedback report();
  void follow_at_once(dds::DriveCommand command, std::uint64_t sender);

  std::string fault_;
  int lost_;
  drives::SimulatedServos servos_;
  const MachineModel& model_;
  std::optional<drive::Group> group_;
  bool is_service_there_ = true, is_restarted_ = false, is_stop_open_ = false;
  std::uint64_t service_ = 41;  ///< participant of the service that is played
  std::int64_t now_ns_ = 1'000'000'000;
  std::uint64_t newest_ = 0, heard_ = 0, stuck_cycle_ = 0;
  std::optional<dds::SetpointSample> last_;
  std::uint16_t word_ = 0;
  int periods_ = 0, mutes_ = 0, silent_ = 0, in_ramp_ = 0, in_fault_ = 0;
};

inline drive::GroupSpec FaultyDrives::spec() {
  drive::GroupSpec spec;
  spec.joints = model_.joint_count;
  spec.cycle_ns = model_.cycle_ns;
  spec.bridge_cycles = is("no-bridge") ? 1 : 3;
  for (int i = 0; i < model_.joint_count; ++i) {
    drive::GroupAxis axis;
    axis.joint = i;
    axis.spec = drive_spec(model_, i);
    axis.homing = drives::homing_of({});
    axis.position = servos_.servo(static_cast<std::size_t>(i)).servo.position;
    if (is("no-travel")) axis.spec.is_endless = true;
    if (is("no-step")) axis.spec.limits.velocity = 0;
    if (is("no-ramp")) axis.spec.limits.fault_acceleration = 0;
    if (is("long-ramp")) axis.spec.limits.fault_acceleration /= 4;
    if (is("no-begin")) axis.spec.limits.following_error = 0;
    spec.axes.push_back(axis);
  }
  return spec;
}

inline void FaultyDrives::follow_at_once(dds::DriveCommand command, std::uint64_t sender) {
  const std::uint16_t wanted = command.controlword;
  for (const std::uint16_t word : {std::uint16_t{0x06}, std::uint16_t{0x07}, wanted}) {
    command.controlword = word;
    (void)group_->take(command, sender);
  }
}

inline void FaultyDrives::say(drives::Speaker who, const dds::DriveCommand& asked) {
  dds::DriveCommand command = asked;
  std::uint64_t sender = number_of(who);
  const DriveState state = group_->axis(command.drive).state();
  if (is("takes-commands-of-all")) {
    if (group_->pin().state() == drive::MasterPin::State::kFree) (void)group_->take(asked, sender);
    sender = group_->pin().master().participant;
    command.service_id = group_->pin().master().service_id;
  }
  if (is("obeys-a-restarted-service") && is_restarted_ && !group_->is_off()) {
    sender = group_->pin().master().participant;
    command.service_id = group_->pin().master().service_id;
  }
  if (is("trusts-the-id") && command.service_id == group_->pin().master().service_id) {
    sender = group_->pin().master().participant;
  }
  if (is("takes-the-newest-when-off") && group_->is_off() && who == drives::Speaker::kOther) {
    group_->see_master(false);
  }
  const std::uint16_t word = command.controlword;
  if (is("jumps") && (word & 0x0F) == 0x0F && state == DriveState::kSwitchOnDisabled) {
    return follow_at_once(command, sender);
  }
  if (is("never-enables") && word == 0x0F) command.controlword = 0x07;
  if (is("no-quick-stop") && word == 0x02) command.controlword = 0x00;
  if (is("no-disable") && word == 0x00 && state == DriveState::kOperationEnabled) return;
  if (is("no-shutdown") && word == 0x06 && state == DriveState::kOperationEnabled) return;
  if (is("no-reset") && (word & 0x80) != 0) command.controlword &= 0x7F;
  if (is("resets-by-level") && (word & 0x80) != 0 && state == DriveState::kFault) {
    command.controlword = 0x00;
    (void)group_->take(command, sender);
    command.controlword = word;
  }
  if (is("resets-by-itself") && word == 0x06 && state == DriveState::kFault) {
    command.controlword = 0x80;
    (void)group_->take(command, sender);
    command.controlword = word;
  }
  if (is("no-homing-mode")) command.mode = dds::kCyclicPositionMode;
  (void)group_->take(command, sender);
  word_ = word;
}

inline void FaultyDrives::say(drives::Speaker who, const dds::SetpointSample& setpoint) {
  dds::SetpointSample sample = setpoint;
  std::uint64_t sender = number_of(who);
  std::int64_t arrival_ns = now_ns_;
  Setpoint& s = sample.setpoint;
  const auto sign = [&] { sample.crc = dds::setpoint_crc(s, group_->pin().master().service_id); };
  if (is("takes-setpoints-of-all")) sender = group_->pin().master().participant;
  if (is("no-checksum")) sign();
  if (is("no-order") && s.cycle <= newest_) s.cycle = newest_ + 1, sign();
  if (is("no-age")) arrival_ns = 0;
  if (is("takes-the-same-again") && who == drives::Speaker::kService && s.cycle == heard_) {
    s.cycle = newest_ + 1, sign();
    arrival_ns = 0;
  }
  if (who == drives::Speaker::kService) heard_ = setpoint.setpoint.cycle;
  if (is("follows-dry-runs") && (s.flags & kSetpointDry) != 0) s.flags = kSetpointEnabled, sign();
  if (is("follows-all") && s.flags == 0 && (word_ & 0x0F) == 0x0F) {
    s.flags = kSetpointEnabled;
    sign();
  }
  if (is("takes-no-numbers") && !(s.position[0] == s.position[0])) return;
  if (is("limits-velocity") && s.velocity[0] > 300) s.velocity[0] = 300, sign();
  const bool is_right = sample.crc == dds::setpoint_crc(s, group_->pin().master().service_id);
  if (is("bridges-standing") && is_right) s.velocity.fill(0), sign();
  if (is("no-step") && std::abs(s.velocity[0]) > 300) {
    return group_->axis(0).fail(drive::kErrorSetpointVelocity);
  }
  newest_ = std::max(newest_, s.cycle);
  last_ = sample;
  mutes_ = silent_ = 0;
  (void)group_->take(sample, sender, arrival_ns);
}

inline bool FaultyDrives::period(std::vector<dds::DriveFeedback>& reports) {
  now_ns_ += model_.cycle_ns;
  ++periods_;
  if (is("no-watchdog") && ++mutes_ > 15 && last_ && is_service_there_) {
    Setpoint& again = last_->setpoint;
    again.cycle += 2;
    for (int i = 0; i < group_->size(); ++i) {
      again.position[static_cast<std::size_t>(i)] = group_->axis(i).position();
    }
    again.velocity.fill(0);
    last_->crc = dds::setpoint_crc(again, group_->pin().master().service_id);
    (void)group_->take(*last_, service_, 0);
  }
  constexpr int kAlone = 10;
  const bool is_held = ++silent_ > kAlone && silent_ <= kAlone + lost_;
  if (is_held) return true;
  group_->see_master(is_master_there());
  group_->work(silent_ == kAlone + lost_ + 1 ? 1 + lost_ : 1, servos_);
  if (is("rare") && periods_ % 100 != 0) return true;
  reports.push_back(report());
  return true;
}

inline dds::DriveFeedback FaultyDrives::report() {
  dds::DriveFeedback report = group_->feedback();
  const bool is_homing = report.mode_display[0] == dds::kHomingMode;
  if (!is_homing) stuck_cycle_ = report.cycle_seen;
  const bool is_enabled = group_->axis(0).state() == DriveState::kOperationEnabled;
  if (is("jerks-when-enabled") && is_enabled) report.position[0] += 0.5;
  if (is("joint-missing")) report.joint_mask &= ~4U;
  if (is("joint-too-many")) report.joint_mask |= 32U;
  if (is("sample-stands")) report.sample = 5;
  if (is("no-number-reported")) report.position[3] = std::numeric_limits<double>::quiet_NaN();
  if (is("nobody-named")) report.service_id = 0;
  const DriveState state = group_->axis(0).state();
  const bool is_silent = group_->axis(0).error() == drive::kErrorSetpointsStopped;
  in_fault_ = state == DriveState::kFault ? in_fault_ + 1 : 0;
  in_ramp_ = state == DriveState::kFaultReaction || in_fault_ > 0 ? in_ramp_ + 1 : 0;
  if (is("jumps-into-its-ramp") && in_ramp_ > 0) {  // and comes back slowly
    // By more than bridge and ramp, which are in one report where periods are lost.
    report.position[0] += std::max(0.0, 7 - 0.1 * in_ramp_);
  }
  if (is("jumps-back-after-its-ramp") && is_silent && in_fault_ > 0) report.position[0] -= 0.5;
  if (is("creeps-after-its-ramp")) report.position[0] += 0.004 * in_fault_;
  report.is_emergency_stop = is_stop_open_ && !is("hides-its-stop");
  if (is("forgets-its-stop") && is_stop_open_) report.is_emergency_stop = periods_ % 40 == 0;
  if (is("no-cycle")) report.cycle_seen = 0;
  if (is("no-cycle-in-homing") && is_homing) report.cycle_seen = stuck_cycle_;
  if (is("mode-not-reported")) report.mode_display.fill(dds::kCyclicPositionMode);
  if (is("keeps-its-reference")) report.referenced_mask = 31;
  if (is("loses-its-reference") && is_homing) report.referenced_mask &= ~1U;
  if (is("does-not-follow")) report.position.fill(0);
  if (is("other-error") && report.error[0] == drive::kErrorSetpointsStopped) {
    report.error.fill(drive::kErrorDevice);
  }
  return report;
}

}  // namespace meridian::test
