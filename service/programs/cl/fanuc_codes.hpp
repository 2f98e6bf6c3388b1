// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace meridian::cl {

/// The first code in `text`, in capitals and outside of comments, that no control but Fanuc and its
/// like has ("G43.4", "G5.1 Q"); empty where there is none. Proof:
/// tests/unit/nc/recognise_test.cpp.
[[nodiscard]] std::string code_of_fanuc(std::string_view text);

/// The same of those that LinuxCNC has too, but neither Siemens nor Klartext: "G43".
[[nodiscard]] std::string code_like_fanuc(std::string_view text);

}  // namespace meridian::cl
