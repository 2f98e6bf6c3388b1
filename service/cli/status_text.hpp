// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "meridian/cycle/state.hpp"
#include "meridian/geometry/vector3.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// The name of a state as it came over the wire; "unknown" where this version knows none.
[[nodiscard]] const char* text_of(State state);
/// Reads the name of a state, upper or lower case.
[[nodiscard]] std::optional<State> parse_state(const std::string& text);
/// Every name, separated by commas.
[[nodiscard]] std::string all_states();

/// How long the program still takes at an override of 100 %, s. Exact where its rest is planned,
/// else by the share of blocks; nothing where no program runs or its length is not known.
struct TimeToGo {
  double seconds = 0;
  bool is_planned = false;
};
[[nodiscard]] std::optional<TimeToGo> time_to_go(const dds::Status& status);

/// A status for a person, several lines. `tool`: where the tool is in the work frame, where that is
/// known.
[[nodiscard]] std::string describe(const dds::Status& status, const dds::MachineInfo& machine,
                                   const std::optional<Pose<double>>& tool = {});
/// A status for a program: one JSON object on one line; units are in the names. Without `tool` its
/// tip and axis are null.
[[nodiscard]] std::string to_json(const dds::Status& status, const dds::MachineInfo& machine,
                                  const std::optional<Pose<double>>& tool = {});

}  // namespace meridian::cli
