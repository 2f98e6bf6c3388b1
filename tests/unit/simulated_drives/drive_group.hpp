// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>

#include "service/drives/simulated/drive_group.hpp"
#include "support/machines.hpp"

namespace meridian::drives {

inline constexpr std::uint64_t kMaster = 41, kOther = 42;  // participants

inline dds::SetpointSample signed_by(std::uint64_t service, const Setpoint& setpoint) {
  return {setpoint, dds::setpoint_crc(setpoint, service)};
}

class Group : public testing::Test {
 protected:
  void command(std::uint16_t controlword, std::uint64_t service = 7,
               std::uint64_t sender = kMaster) {
    for (std::uint8_t i = 0; i < 5; ++i) {
      dds::DriveCommand word;
      word.drive = i;
      word.controlword = controlword;
      word.service_id = service;
      group_.take(word, sender);
    }
  }
  /// The drives' own ramp is over.
  void come_to_rest() {
    for (int n = 0; n < 200; ++n) group_.work(1);
  }
  void enable() {
    for (const std::uint16_t controlword : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F})
      command(controlword);
  }
  void hear(const dds::MachineInfo& machine, std::uint64_t sender) {
    if (const auto bridge = drive::bridge_of(machine, sender)) group_.take(*bridge);
  }
  void send(double x, std::uint16_t flags = kSetpointEnabled, double velocity = 0) {
    Setpoint setpoint;
    setpoint.cycle = ++cycle_;
    setpoint.position[0] = x;
    setpoint.velocity[0] = velocity;
    setpoint.flags = flags;
    group_.take(signed_by(7, setpoint), kMaster);
  }

  /// For how many periods the drives go on when the master says nothing more.
  [[nodiscard]] int periods_of_silence_bridged() {
    int periods = 0;
    for (send(0); group_.drive(0).state() == DriveState::kOperationEnabled; ++periods) {
      group_.work(1);
      if (periods > 100) break;
    }
    return periods;
  }

  MachineModel model_ = test::lai_machine();
  DriveGroup group_{model_, {LagKind::kFirstOrder, 0}};
  std::uint64_t cycle_ = 100;
};

}  // namespace meridian::drives
