// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/bridge/drive_positions.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::bridge {

/// As diagnostic_msgs/DiagnosticStatus counts them.
enum class Level : std::uint8_t { kOk, kWarning, kError, kStale };

struct Diagnosis {
  Level level = Level::kOk;
  std::string name{}, message{};
  std::vector<std::pair<std::string, std::string>> values{};
};

/// What ROS 2's tools show of the machine: the program and its alarm, the drives, real time.
/// `status`: the newest; null: none came for 2 s. Proof: tests/unit/bridge/diagnostics_test.cpp.
[[nodiscard]] std::vector<Diagnosis> diagnose(const MachineModel& model, const dds::Status* status,
                                              const DrivePositions& drives);

/// diagnostic_msgs/DiagnosticArray; `message` is begun anew.
void put_diagnostics(ros::Cdr& message, std::int64_t time_ns, const std::string& machine,
                     const std::vector<Diagnosis>& all);

}  // namespace meridian::bridge
