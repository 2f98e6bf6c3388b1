// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/served_model.hpp"

#include "service/machine/file/machine_file.hpp"

namespace meridian::stream {

MachineModel whole_model(const dds::MachineInfo& info) {
  MachineModel model = config::parse_machine(info.machine_file, info.name);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      model.frame_rotation(row, column) =
          info.frame_rotation[static_cast<std::size_t>(3 * row + column)];
    }
    model.frame_origin_mm[row] = info.frame_origin_mm[static_cast<std::size_t>(row)];
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

std::map<int, Vector3> served_work_zeros(const dds::MachineInfo& info) {
  std::map<int, Vector3> zeros;
  for (const WorkFrame& row : info.work_frames) zeros[row.number] = to_vector(row.origin_mm);
  return zeros;
}

}  // namespace meridian::stream
