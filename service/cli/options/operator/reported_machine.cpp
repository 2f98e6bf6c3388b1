// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/reported_machine.hpp"

#include "service/machine/file/machine_file.hpp"
#include "service/protocol/frame_sum.hpp"

namespace meridian::cli {

std::optional<MachineModel> reported_machine(const dds::MachineInfo& info) {
  if (info.machine_file.empty()) return std::nullopt;
  MachineModel model = config::parse_machine(info.machine_file, "machine file of the service");
  stream::place_frame(model, info.frame_rotation, info.frame_origin_mm);
  shrink_travel(model, travel_under(info.soft_limits, model));
  return model;
}

}  // namespace meridian::cli
