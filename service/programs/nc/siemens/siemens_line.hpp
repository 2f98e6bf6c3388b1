// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "service/programs/cl/refusal.hpp"
#include "service/programs/nc/nc_line.hpp"
#include "service/programs/nc/words/variables.hpp"

namespace meridian::nc {

/// Names with a value that says how exactly and how hard the control moves: CTOL=0.01.
[[nodiscard]] std::span<const std::string_view> setting_names() noexcept;

/// Cuts a line of a Siemens program into `line`: addresses with `=` or without, `X=IC(2.)`, names
/// with their arguments (TRAORI(1)). DEF and assignments go to `variables`, and names that stand
/// for a number are read as that number. Refused by name: expressions, and variables of the
/// control. Proof: tests/unit/nc/siemens_test.cpp, siemens_variable_test.cpp.
[[nodiscard]] cl::Outcome cut_siemens(std::string_view text, std::uint32_t number, Line& line,
                                      Variables& variables);

}  // namespace meridian::nc
