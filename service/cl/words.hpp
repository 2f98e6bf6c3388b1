// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace meridian::cl {

/// What the reader does with a major word.
enum class Word : std::uint8_t {
  kUnknown,     ///< refused unless allowed
  kSilent,      ///< says nothing about motion: names, notes, tolerances of the CAM system
  kDisplay,     ///< for viewers: skipped with one warning
  kSkipped,     ///< means something to a post-processor that Meridian has no use for: one warning
  kInsert,      ///< INSERT: text for another control, skipped with one warning
  kRefused,     ///< moves the machine in a way that a CL path cannot show: refused with the reason
  kVendor,      ///< an action of the machine's own: becomes a vendor word block
  kArc,         ///< CIRCLE
  kGoto,        ///< GOTO
  kGoDelta,     ///< GODLTA
  kFrom,        ///< FROM
  kRapid,       ///< RAPID
  kFeed,        ///< FEDRAT
  kUnits,       ///< UNITS, UNIT
  kMsys,        ///< MSYS
  kCsys,        ///< CSYS
  kTransform,   ///< TRNTYP
  kToolAxis,    ///< TLAXIS
  kForward,     ///< INDIRV
  kToolOn,      ///< TLON
  kLoadTool,    ///< LOADTL
  kLoad,        ///< LOAD
  kToolData,    ///< TLDATA, CUTTER: geometry, for the summary
  kToolPath,    ///< TOOL PATH
  kEndOfPath,   ///< END-OF-PATH
  kSpindle,     ///< SPINDL
  kCoolant,     ///< COOLNT
  kDelay,       ///< DELAY, DWELL
  kStop,        ///< STOP
  kOptionStop,  ///< OPSTOP
  kEnd,         ///< END
  kFini,        ///< FINI
  kSet,         ///< SET, MODE
  kCycle,       ///< CYCLE
  kCutCom,      ///< CUTCOM
  kOrigin,      ///< ORIGIN
  kProgram,     ///< PARTNO
  kNote         ///< PPRINT
};

/// The meaning of a major word, given in capitals.
[[nodiscard]] Word find_word(std::string_view major) noexcept;

/// Why a word of kind kRefused is refused.
[[nodiscard]] std::string_view refusal(std::string_view major) noexcept;

}  // namespace meridian::cl
