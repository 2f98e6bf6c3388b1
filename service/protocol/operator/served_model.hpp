// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "meridian/kinematics/machine_model.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

/// The machine as its service has it: the file that it publishes, with the frame and the tool in
/// force, and the travel of that file.
/// Throws config::ConfigError where the file did not fit the topic, or another version wrote it.
[[nodiscard]] MachineModel whole_model(const dds::MachineInfo& info);

/// The same with the travel that soft limits leave it, by which programs are checked.
[[nodiscard]] MachineModel served_model(const dds::MachineInfo& info);

/// Names, kinds and limits of its joints and drives alone, for who shows a machine whose file did
/// not fit the topic: it has no kinematics.
[[nodiscard]] MachineModel named_model(const dds::MachineInfo& info);

/// Where the zeros of its work frames lie in the frame of the kinematics, mm, by their numbers.
[[nodiscard]] std::map<int, Vector3> served_work_zeros(const dds::MachineInfo& info);

}  // namespace meridian::stream
