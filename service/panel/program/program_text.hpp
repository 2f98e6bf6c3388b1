// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "service/panel/desks/program_desk.hpp"

namespace meridian::panel {

/// {"t":"program", "phase", "name", "findings": [...], ...}: all that a page shows of the program.
[[nodiscard]] std::string program_text(const ProgramDesk::View& view);

}  // namespace meridian::panel
