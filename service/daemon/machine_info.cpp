// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/machine_info.hpp"

#include <unistd.h>

#include <array>

#include "interpolator_version.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/protocol/frame_sum.hpp"

namespace meridian::interpolator {
namespace {

[[nodiscard]] const char* word_of(const MachineModel& model) {
  if (model.family == MachineFamily::kChain) return "chain";
  if (model.family == MachineFamily::kRobot) return model.joint_count == 6 ? "robot6" : "robot5";
  return "lai";
}

}  // namespace

dds::MachineInfo machine_info(const ServiceParts& parts, std::uint64_t service_id) {
  const MachineModel& model = parts.model;
  std::array<char, 64> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  dds::MachineInfo info;
  info.service_id = service_id;
  info.name = model.name;
  info.file_version = model.version;
  info.service_version = kVersion;
  info.host = host.data();
  info.pid = static_cast<std::uint32_t>(::getpid());
  info.kinematics = word_of(model);
  info.cycle_ns = model.cycle_ns;
  info.bridge_cycles = static_cast<std::uint32_t>(model.bridge_cycles);
  info.joint_count = static_cast<std::uint32_t>(model.joint_count);
  for (int joint = 0; joint < model.joint_count; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    const JointSpec& spec = model.joints[i];
    info.joints[i] = {spec.name,       spec.is_rotary,
                      spec.is_endless, static_cast<std::uint16_t>(joint),
                      spec.limits,     spec.home};
  }
  info.stage_drive_count = has_stage(model) ? kStageDrives : 0;
  for (int i = model.joint_count; i < limited_count(model); ++i) {
    const JointSpec& spec = limited_spec(model, i);
    const auto k = static_cast<std::size_t>(i - model.joint_count);
    const int model_joint = k == 0 ? model.stage.linear_joint : model.stage.rotary_joint;
    info.stage_drives[k] = {spec.name,       spec.is_rotary,
                            spec.is_endless, static_cast<std::uint16_t>(model_joint),
                            spec.limits,     spec.home};
  }
  info.max_feed_mm_per_min = units::per_min_from_per_s(model.max_feed_mm_per_s);
  info.tip_tolerance_mm = model.tolerances.tip_mm;
  info.axis_tolerance_rad = model.tolerances.axis_rad;
  info.tool_length_mm = model.tool_length_mm;
  info.frame_rotation = stream::rows_of(model.X_MW.rotation);
  info.frame_origin_mm = to_array(model.X_MW.origin_mm);
  if (parts.machine_file.size() <= dds::kMachineFileBytes) info.machine_file = parts.machine_file;
  if (parts.tool_file.size() <= dds::kToolFileBytes) info.tool_file = parts.tool_file;
  return info;
}

}  // namespace meridian::interpolator
