// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// Whether `name` is a drilling cycle of Siemens: CYCLE81 to CYCLE83, CYCLE85, CYCLE89.
[[nodiscard]] bool is_siemens_drilling(std::string_view name);

/// What CYCLE81(RTP, RFP, SDIS, DP, DPR, ...) and cycles like it ask for. A depth that is given
/// twice has to be the same. Refused: depths of the tool's shank, a slower first peck, other
/// planes. Proof: tests/unit/nc/siemens_cycle_test.cpp.
[[nodiscard]] Expected<Drilling, cl::Refusal> siemens_drilling(const State& s,
                                                               const Line::Name& name);

}  // namespace meridian::nc
