// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/operator/served_model.hpp"

#include <algorithm>

#include "service/machine/file/machine_file.hpp"

namespace meridian::stream {
namespace {

[[nodiscard]] JointSpec spec_of(const dds::JointInfo& joint) {
  JointSpec spec;
  spec.name = joint.name;
  spec.is_rotary = joint.is_rotary;
  spec.is_endless = joint.is_endless;
  spec.limits = joint.limits;
  spec.home = joint.home;
  return spec;
}

}  // namespace

MachineModel whole_model(const dds::MachineInfo& info) {
  MachineModel model = config::parse_machine(info.machine_file, info.name);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      model.X_MW.rotation(row, column) =
          info.frame_rotation[static_cast<std::size_t>(3 * row + column)];
    }
    model.X_MW.origin_mm[row] = info.frame_origin_mm[static_cast<std::size_t>(row)];
  }
  model.tool_length_mm = info.tool_length_mm;
  model.bridge_cycles = static_cast<int>(info.bridge_cycles);
  return model;
}

MachineModel served_model(const dds::MachineInfo& info) {
  MachineModel model = whole_model(info);
  shrink_travel(model, travel_under(info.soft_limits, model));
  return model;
}

MachineModel named_model(const dds::MachineInfo& info) {
  MachineModel model;
  model.name = info.name;
  model.cycle_ns = info.cycle_ns;
  model.joint_count = static_cast<int>(std::min<std::size_t>(info.joint_count, kMaxJoints));
  std::transform(info.joints.begin(), info.joints.end(), model.joints.begin(), spec_of);
  std::transform(info.stage_drives.begin(), info.stage_drives.end(), model.stage_drives.begin(),
                 spec_of);
  // Which stage it is makes no difference to its names.
  if (info.stage_drive_count > 0) model.stage.kind = StageKind::kTwoSlider;
  return model;
}

std::map<int, Vector3> served_work_zeros(const dds::MachineInfo& info) {
  std::map<int, Vector3> zeros;
  for (const WorkFrame& row : info.work_frames) zeros[row.number] = to_vector(row.origin_mm);
  return zeros;
}

}  // namespace meridian::stream
