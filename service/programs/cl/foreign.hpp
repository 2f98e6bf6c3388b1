// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "service/programs/cl/dialect.hpp"

namespace meridian::cl {

struct Recognised {
  /// What a text is that is no CL file, e.g. "a Siemens NC program (TRAORI)" or "a ZIP archive";
  /// empty where nothing speaks against a CL file.
  std::string foreign;
  /// More of the text would say nothing else.
  bool is_certain = false;
  bool is_nc = false;                   ///< it is an NC program
  Dialect program = Dialect::kUnknown;  ///< of an NC program whose words show it for certain
  std::string shown_by;                 ///< the word that shows it: "G43.4"
  std::string like_fanuc;               ///< a code of Fanuc that LinuxCNC has too: "G43"
};

/// `head` is the first 64 KiB or less.
///
/// NC programs are known by what only they have; a text with a CL word and its slash in it is none.
[[nodiscard]] Recognised recognise_foreign(std::string_view head);

}  // namespace meridian::cl
