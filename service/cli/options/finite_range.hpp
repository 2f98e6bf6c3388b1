// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace meridian::cli {

/// Checks that an option is a number that is finite and for which `is_good` holds.
template <class IsGood>
[[nodiscard]] CLI::Validator finite_number(IsGood is_good, const std::string& description) {
  return {[is_good, description](std::string& text) {
            double value = 0;
            const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
            return is_number && is_good(value) ? std::string{}
                                               : "Value " + text + " is not " + description;
          },
          description};
}

/// A number from `min` to `max`. CLI::Range passes NaN, which is neither below nor above.
[[nodiscard]] inline CLI::Validator finite_range(double min, double max) {
  return finite_number([min, max](double value) { return value >= min && value <= max; },
                       CLI::Range(min, max).get_description());
}

/// A number above zero. CLI::PositiveNumber passes NaN.
[[nodiscard]] inline CLI::Validator finite_positive() {
  return finite_number([](double value) { return value > 0; },
                       CLI::PositiveNumber.get_description());
}

}  // namespace meridian::cli
