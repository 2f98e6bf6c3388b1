// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "service/programs/cl/refusal.hpp"
#include "service/programs/nc/words/variables.hpp"

/// Q parameters of Klartext that stand for numbers. As no jump, label and condition is run, each
/// stands for the number that the last line above gave it. Proof:
/// tests/unit/nc/heidenhain_parameter_test.cpp.
namespace meridian::nc {

/// How many signs at the front of `text` name a parameter: Q5, QL20, QR3; 0: none.
[[nodiscard]] std::size_t length_of_parameter(std::string_view text) noexcept;

/// Whether the program has it for itself: Q0 to Q99, QL and QR. Others are of cycles and the
/// control.
[[nodiscard]] bool is_free_parameter(std::string_view name) noexcept;

/// "+Q5", "-Q5": its number; nothing where no line gave it one.
[[nodiscard]] std::optional<double> number_of_parameter(std::string_view text,
                                                        const Variables& variables);

/// The same, or the number that `text` is, whose point may be a comma: "+3,5".
[[nodiscard]] std::optional<double> read_number(std::string_view text, const Variables& variables);

/// "Q5 = +3,5", and what stands after the colon of FN 0: Q5 = +3,5. Expressions are refused.
[[nodiscard]] cl::Outcome assign_parameter(std::string_view text, Variables& variables);

}  // namespace meridian::nc
