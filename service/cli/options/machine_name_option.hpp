// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "service/machine/file/machine_name.hpp"

namespace meridian::cli {

/// Of an option that names a machine: it is its DDS partition, where `*` would mean all of them.
[[nodiscard]] inline CLI::Validator machine_name() {
  return CLI::Validator(
      [](const std::string& name) {
        return config::is_machine_name(name)
                   ? std::string()
                   : std::string("is no name of a machine: ") + config::kMachineNameWords;
      },
      "NAME");
}

}  // namespace meridian::cli
