// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace meridian::panel {

/// What `meridian doctor` finds on this host, as its `--json` says it.
/// Rights and DDS peers are left to the command: here they would be those of the panel, not of the
/// service. Takes some milliseconds. Any thread.
[[nodiscard]] std::string doctor_text();

}  // namespace meridian::panel
