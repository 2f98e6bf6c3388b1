// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

/// Numbers and comments as controllers read them.
namespace meridian::post {

/// `value` with exactly `decimals` digits after the point; no exponent, never "-0.000".
[[nodiscard]] std::string fixed(double value, int decimals);

/// The number that fixed() writes.
[[nodiscard]] double rounded(double value, int decimals);

/// As fixed(), but above `value` by rounding of the last bits at most: a feed that is written is
/// not faster than the one meant.
[[nodiscard]] std::string fixed_down(double value, int decimals);

/// `text` for a comment of any controller: letters, digits, space and . , + - / = only, everything
/// else an underscore, at most 64 characters. A comment can neither end early nor mean anything.
[[nodiscard]] std::string harmless(std::string_view text);

}  // namespace meridian::post
