// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "meridian/rt/state.hpp"
#include "service/dds/messages.hpp"

namespace meridian::cli {

/// The name of a state as it came over the wire; "unknown" where this version knows none.
[[nodiscard]] const char* text_of(State state);
/// Reads the name of a state, upper or lower case.
[[nodiscard]] std::optional<State> parse_state(const std::string& text);
/// Every name, separated by commas.
[[nodiscard]] std::string all_states();

/// A status for a person, several lines.
[[nodiscard]] std::string describe(const dds::Status& status, const dds::MachineInfo& machine);
/// A status for a program: one JSON object on one line; units are in the names.
[[nodiscard]] std::string to_json(const dds::Status& status, const dds::MachineInfo& machine);

}  // namespace meridian::cli
