// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "service/cl/refusal.hpp"
#include "service/nc/nc_line.hpp"

namespace meridian::nc {

/// Cuts a line of a Siemens program into `line`: addresses with `=` or without, `X=IC(2.)`, names
/// with their arguments (TRAORI(1)). Refused by name: R parameters, variables, expressions.
/// Proof: tests/unit/nc/siemens_test.cpp.
[[nodiscard]] cl::Outcome cut_siemens(std::string_view text, std::uint32_t number, Line& line);

}  // namespace meridian::nc
