// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/rt/state.hpp"

namespace meridian::simulate {

/// What an operator asked for, and when. `cycle` counts from the cycle that took the start.
struct OperatorEvent {
  std::int64_t cycle = 0;
  Verb verb = Verb::kHold;
  double argument = 0;
};

/// Reads operator events: a row `cycle,verb[,argument]` each, in the order of cycles; the header
/// `cycle,verb,argument`, empty lines and lines that begin with # are skipped. Verbs are those of
/// name_of(Verb); an override's argument is its factor. A row `start` says which cycle the others
/// count from (that of a live run); without one they count from the start as they are. Verbs before
/// the start are not replayed. A row `incomplete`, by which a recorder says that it lost events, is
/// refused. The error is a message with name and line. Proof:
/// tests/unit/simulate/operator_events_test.cpp.
[[nodiscard]] Expected<std::vector<OperatorEvent>, std::string> read_operator_events(
    std::string_view text, const std::string& name);

}  // namespace meridian::simulate
