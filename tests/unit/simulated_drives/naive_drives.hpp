// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "meridian/cycle/drive_state.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/kit/csp/cia402.hpp"
#include "service/drives/simulated/check/checked_drives.hpp"

namespace meridian::test {

/// What somebody writes in an afternoon: it walks the states as it is told to, and the drives are
/// where the newest setpoint says.
class NaiveDrives : public drives::CheckedDrives {
 public:
  explicit NaiveDrives(const MachineModel& model) {
    cycle_ns_ = model.cycle_ns;
    report_.joint_mask = (1U << static_cast<unsigned>(model.joint_count)) - 1;
    report_.referenced_mask = report_.joint_mask;
    report_.mode_display.fill(dds::kCyclicPositionMode);
    states_.fill(DriveState::kSwitchOnDisabled);
  }

  void say(drives::Speaker, const dds::MachineInfo&) override {}
  void say(drives::Speaker, const dds::DriveCommand& command) override {
    DriveState& state = states_[command.drive];
    state = drive::next_state(state, command.controlword, words_[command.drive]);
    words_[command.drive] = command.controlword;
    report_.service_id = command.service_id;
  }
  void say(drives::Speaker, const dds::SetpointSample& sample) override {
    report_.position = sample.setpoint.position;
    report_.cycle_seen = sample.setpoint.cycle;
  }
  void end(drives::Speaker) override {}
  void begin(drives::Speaker) override {}
  void ask(drives::Wish) override {}
  [[nodiscard]] bool period(std::vector<dds::DriveFeedback>& reports) override {
    now_ns_ += cycle_ns_;
    ++report_.sample;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      report_.statusword[i] = drive::statusword(states_[i]);
    }
    reports.push_back(report_);
    return true;
  }
  [[nodiscard]] std::int64_t now_ns() const override { return now_ns_; }

 private:
  dds::DriveFeedback report_;
  std::array<DriveState, kMaxJoints> states_{};
  std::array<std::uint16_t, kMaxJoints> words_{};
  std::int64_t cycle_ns_ = 0, now_ns_ = 1'000'000'000;
};

}  // namespace meridian::test
