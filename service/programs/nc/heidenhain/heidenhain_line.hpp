// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "service/programs/cl/refusal.hpp"
#include "service/programs/nc/nc_line.hpp"
#include "service/programs/nc/words/variables.hpp"

namespace meridian::nc {

/// Cuts a line of Klartext into `line`: the first of `names` is its statement (`L`, `TOOL CALL`)
/// with the rest of the line as arguments, the others are words without a number (`FMAX`, `DR+`).
/// Refused by name: Q parameters without a number and what has no word for itself here.
/// Proof: tests/unit/nc/heidenhain_test.cpp.
[[nodiscard]] cl::Outcome cut_heidenhain(std::string_view text, std::uint32_t number, Line& line,
                                         const Variables& variables);

}  // namespace meridian::nc
