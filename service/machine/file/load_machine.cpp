// SPDX-License-Identifier: Apache-2.0
#include "meridian/machine_file.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian {

Expected<MachineModel, std::string> load_machine(const std::string& path) {
  try {
    return config::load_machine(path);
  } catch (const config::ConfigError& error) {
    return tl::unexpected<std::string>(error.what());
  }
}

}  // namespace meridian
