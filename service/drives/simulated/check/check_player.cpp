// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/check/check_player.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "meridian/kinematics/limited.hpp"

namespace meridian::drives {

std::string in_hex(std::uint16_t value) {
  char text[8];
  std::snprintf(text, sizeof text, value > 0xFF ? "%04Xh" : "%02Xh", value);
  return text;
}

CheckPlayer::CheckPlayer(const MachineModel& model, CheckedDrives& drives)
    : model_(model), drives_(drives), dt_s_(static_cast<double>(model.cycle_ns) * 1e-9) {
  modes.fill(dds::kCyclicPositionMode);
}

void CheckPlayer::find(Rule rule, const std::string& seen) {
  const auto same = [rule](const Finding& one) { return one.rule == rule; };
  if (std::none_of(findings.begin(), findings.end(), same)) findings.push_back({rule, seen});
}

void CheckPlayer::tick(const Also& also) {
  constexpr std::int64_t kBetweenClaims = 500, kLongestSilence = 60;
  if (saying == Saying::kNothing) {
    spoken_ = 0;
  } else {
    if (spoken_ % kBetweenClaims == 0) say_claim();
    say_commands();
    cycle_ += 2;
    say_setpoint();
    ++spoken_;
  }
  if (also) also(drives_);
  reports_.clear();
  if (!drives_.period(reports_)) is_disturbed = true;
  ++ticks_;
  for (const dds::DriveFeedback& report : reports_) read(report);
  if (is_any_reported() && !is_disturbed && ticks_ - reported_ > kLongestSilence) {
    find(Rule::kInTime, "no report for " + std::to_string(kLongestSilence) + " periods");
  }
}

void CheckPlayer::ticks(int count, const Also& also) {
  for (int n = 0; n < count; ++n) tick(also);
}

bool CheckPlayer::until(const std::function<bool()>& is_reached, int periods) {
  for (int n = 0; n < periods && !is_reached(); ++n) tick();
  return is_reached();
}

void CheckPlayer::say_claim() {
  dds::MachineInfo machine;
  machine.name = model_.name;
  machine.service_id = service_id_;
  machine.is_serving = true;
  machine.bridge_cycles = kBridge;
  drives_.say(Speaker::kService, machine);
}

void CheckPlayer::say_commands() {
  constexpr std::int64_t kRepeat = 100;
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool is_same = words[at] == said_words_[at] && modes[at] == said_modes_[at];
    if (is_same && spoken_ % kRepeat != 0) continue;
    said_words_[at] = words[at];
    said_modes_[at] = modes[at];
    dds::DriveCommand command;
    command.drive = static_cast<std::uint8_t>(i);
    command.controlword = words[at];
    command.mode = modes[at];
    command.service_id = service_id_;
    command.sample = ++command_;
    drives_.say(Speaker::kService, command);
  }
}

void CheckPlayer::say_setpoint() {
  if (saying == Saying::kNoSetpoints) return;
  if (saying != Saying::kLastSetpointAgain) {
    last_ = odd_setpoint();
    --last_.setpoint.cycle;
    sign(last_, service_id_);
  }
  drives_.say(Speaker::kService, last_);
  if (saying == Saying::kSetpointsTwice) drives_.say(Speaker::kService, last_);
}

void CheckPlayer::end_service() {
  drives_.end(Speaker::kService);
  saying = Saying::kNothing;
}

void CheckPlayer::restart_service() {
  drives_.begin(Speaker::kService);
  service_id_ = kRestartedId;
  saying = Saying::kAll;
  cycle_ = 0;
  spoken_ = 0;
}

dds::SetpointSample CheckPlayer::odd_setpoint() const {
  dds::SetpointSample sample;
  sample.setpoint.cycle = cycle_ + 1;
  sample.setpoint.due_ns = drives_.now_ns();
  sample.setpoint.position = target;
  sample.setpoint.velocity = velocity;
  sample.setpoint.flags = flags;
  sign(sample, service_id_);
  return sample;
}

void CheckPlayer::sign(dds::SetpointSample& sample, std::uint64_t service_id) {
  sample.crc = dds::setpoint_crc(sample.setpoint, service_id);
}

void CheckPlayer::command_all(Speaker who, std::uint64_t service_id, std::uint16_t word) {
  for (int i = 0; i < count(); ++i) {
    dds::DriveCommand command;
    command.drive = static_cast<std::uint8_t>(i);
    command.controlword = word;
    command.service_id = service_id;
    command.sample = ++command_;
    drives_.say(who, command);
  }
}

void CheckPlayer::read(const dds::DriveFeedback& report) {
  reported_ = ticks_;
  std::uint64_t& sample = samples_[report.drive_group];
  if (report.sample <= sample) {
    find(Rule::kSampleCounts,
         "sample " + std::to_string(report.sample) + " behind " + std::to_string(sample));
  }
  sample = report.sample;
  if ((report.joint_mask >> static_cast<unsigned>(count())) != 0) {
    find(Rule::kKnownJoints, "joint_mask " + std::to_string(report.joint_mask));
  }
  newest.joint_mask |= report.joint_mask;
  newest.cycle_seen = report.cycle_seen;
  newest.service_id = report.service_id;
  const std::uint32_t group = 1U << (report.drive_group % 32U);
  stopped_groups_ = report.is_emergency_stop ? stopped_groups_ | group : stopped_groups_ & ~group;
  newest.is_emergency_stop = stopped_groups_ != 0;
  if (report.cycle_seen % 2 == 1) has_seen_odd = true;
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::uint32_t bit = 1U << at;
    if ((report.joint_mask & bit) == 0) continue;
    if (std::isfinite(report.position[at])) {
      newest.position[at] = report.position[at];
    } else {
      find(Rule::kNumbers, "the position of drive " + drive_spec(model_, i).name);
    }
    newest.statusword[at] = report.statusword[at];
    newest.error[at] = report.error[at];
    newest.mode_display[at] = report.mode_display[at];
    newest.referenced_mask = (newest.referenced_mask & ~bit) | (report.referenced_mask & bit);
  }
}

DriveState CheckPlayer::state(int drive) const {
  return drive_state(newest.statusword[static_cast<std::size_t>(drive)]);
}

bool CheckPlayer::are_all(DriveState wanted) const {
  for (int i = 0; i < count(); ++i) {
    const bool is_reported = (newest.joint_mask >> static_cast<unsigned>(i) & 1U) != 0;
    if (is_reported && state(i) != wanted) return false;
  }
  return true;
}

bool CheckPlayer::is_any(DriveState wanted) const {
  for (int i = 0; i < count(); ++i) {
    if (state(i) == wanted) return true;
  }
  return false;
}

bool CheckPlayer::is_heard() const {
  constexpr std::uint64_t kPeriods = 60;
  return newest.cycle_seen <= cycle_ + 1 && newest.cycle_seen + 2 * kPeriods >= cycle_;
}

void CheckPlayer::stand() {
  target = newest.position;
  velocity.fill(0);
}

}  // namespace meridian::drives
