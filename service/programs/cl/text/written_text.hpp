// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace meridian::cl {

/// "3.5" and the like for messages: six significant digits.
[[nodiscard]] std::string short_number(double value);

/// What a file says, in quotes and fit for a message: at most 40 characters, printable.
[[nodiscard]] std::string quoted(std::string_view text);

}  // namespace meridian::cl
