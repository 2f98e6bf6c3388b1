// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/machine_axes.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::drive {
namespace {

[[noreturn]] void refuse(const Axis& axis, const std::string& why) {
  throw DriveError("axis '" + axis.name + "': " + why);
}

void check(const Axis& axis, std::uint32_t& joints) {
  if (axis.joint < 0 || axis.joint >= kMaxJoints) {
    refuse(axis, "joint is " + std::to_string(axis.joint) + ", and must be from 0 to " +
                     std::to_string(kMaxJoints - 1) + ", its place in drive order");
  }
  const std::uint32_t bit = 1U << static_cast<unsigned>(axis.joint);
  if ((joints & bit) != 0) {
    refuse(axis, "another axis has joint " + std::to_string(axis.joint) + "; give each its own");
  }
  joints |= bit;
  for (const double limit : {axis.velocity, axis.following_error, axis.fault_acceleration,
                             axis.homing.search_distance}) {
    if (!(std::isfinite(limit) && limit >= 0)) {
      refuse(axis, "a limit is no number or negative; 0 means that it is not checked");
    }
  }
  if (!(std::isfinite(axis.travel_min) && std::isfinite(axis.travel_max) &&
        std::isfinite(axis.homing.search_velocity) && std::isfinite(axis.homing.index_position))) {
    refuse(axis, "travel or homing is no number");
  }
  const bool has_velocity = axis.homing.search_velocity != 0;
  if (axis.homing.method == HomingMethod::kByIndex && !has_velocity) {
    refuse(axis, "homing by the index pulse needs search_velocity, with its sign");
  }
  if (axis.velocity > 0 && std::abs(axis.homing.search_velocity) > axis.velocity) {
    refuse(axis, "search_velocity is beyond velocity");
  }
}

[[nodiscard]] JointSpec spec_of(const Axis& axis) {
  JointSpec spec;
  spec.name = axis.name;
  spec.is_rotary = axis.is_rotary;
  spec.is_endless = axis.is_endless;
  spec.limits.travel_min = axis.travel_min;
  spec.limits.travel_max = axis.travel_max;
  spec.limits.velocity = axis.velocity;
  spec.limits.following_error = axis.following_error;
  spec.limits.fault_acceleration = axis.fault_acceleration;
  return spec;
}

}  // namespace

MachineModel load_model(const std::string& machine_file) {
  try {
    return config::load_machine(machine_file);
  } catch (const config::ConfigError& error) {
    throw DriveError(error.what());
  }
}

std::vector<Axis> axes_of_model(const MachineModel& model) {
  std::vector<Axis> axes;
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& spec = drive_spec(model, i);
    Axis axis;
    axis.name = spec.name;
    axis.joint = i;
    axis.is_rotary = spec.is_rotary;
    axis.is_endless = spec.is_endless;
    axis.home = spec.home;
    axis.travel_min = spec.limits.travel_min;
    axis.travel_max = spec.limits.travel_max;
    axis.velocity = spec.limits.velocity;
    axis.following_error = spec.limits.following_error;
    axis.fault_acceleration = spec.limits.fault_acceleration;
    axes.push_back(axis);
  }
  return axes;
}

Options complete(const Options& asked) {
  Options options = asked;
  if (!options.machine_file.empty()) {
    const MachineModel model = load_model(options.machine_file);
    if (options.machine.empty()) options.machine = model.name;
    if (options.axes.empty()) options.axes = axes_of_model(model);
    if (options.cycle_ns == 0) options.cycle_ns = model.cycle_ns;
    if (options.bridge_cycles == 0) options.bridge_cycles = model.bridge_cycles;
    if (options.machine_joints == 0) options.machine_joints = model.joint_count;
  }
  if (options.machine.empty()) {
    throw DriveError("no machine: give Options::machine_file, or machine, axes and cycle_ns");
  }
  if (options.axes.empty()) throw DriveError("no axes: give Options::axes or machine_file");
  if (options.cycle_ns < 50'000 || options.cycle_ns > 100'000'000) {
    throw DriveError("cycle_ns is " + std::to_string(options.cycle_ns) +
                     ", and must be from 50000 to 100000000, the machine's cycle time");
  }
  if (options.bridge_cycles == 0) options.bridge_cycles = 3;
  if (options.bridge_cycles < 0) throw DriveError("bridge_cycles is negative");
  std::uint32_t joints = 0;
  for (std::size_t i = 0; i < options.axes.size(); ++i) {
    Axis& axis = options.axes[i];
    if (axis.joint < 0) axis.joint = static_cast<int>(i);
    check(axis, joints);
    options.machine_joints = std::max(options.machine_joints, axis.joint + 1);
  }
  return options;
}

GroupSpec group_of(const Options& options, Hardware& hardware) {
  GroupSpec group;
  group.number = options.group;
  group.joints = options.machine_joints;
  group.cycle_ns = options.cycle_ns;
  group.bridge_cycles = options.bridge_cycles;
  for (std::size_t i = 0; i < options.axes.size(); ++i) {
    const Axis& axis = options.axes[i];
    const double position = hardware.read(static_cast<int>(i)).position;
    if (!std::isfinite(position)) refuse(axis, "its first position is no number");
    group.axes.push_back({spec_of(axis), axis.homing, axis.joint, position});
  }
  return group;
}

}  // namespace meridian::drive
