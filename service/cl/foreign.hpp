// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace meridian::cl {

/// What a text is that is no CL file, e.g. "a Siemens NC program (TRAORI)" or "a ZIP archive";
/// empty where nothing speaks against a CL file. `head` is the first 64 KiB or less.
///
/// NC programs are told by what only they have; a text with APT motion words in it is none.
[[nodiscard]] std::string recognise_foreign(std::string_view head);

}  // namespace meridian::cl
