// SPDX-License-Identifier: Apache-2.0
#include "service/cl/words.hpp"

#include <algorithm>
#include <array>

namespace meridian::cl {
namespace {

struct Entry {
  std::string_view text;
  Word word;
};

constexpr std::array kTable = std::to_array<Entry>({
    {"AIR", Word::kVendor},
    {"ARCSLP", Word::kSkipped},
    {"AUTOPS", Word::kSilent},
    {"AUXFUN", Word::kVendor},
    {"BREAK", Word::kSkipped},
    {"CALL", Word::kRefused},
    {"CALSUB", Word::kRefused},
    {"CIRCLE", Word::kArc},
    {"CLAMP", Word::kVendor},
    {"CLEARP", Word::kSkipped},
    {"CLPRNT", Word::kSilent},
    {"CONTRL", Word::kSilent},
    {"COOLNT", Word::kCoolant},
    {"COPY", Word::kRefused},
    {"CSYS", Word::kCsys},
    {"CUTCOM", Word::kCutCom},
    {"CUTTER", Word::kToolData},
    {"CYCLE", Word::kCycle},
    {"DELAY", Word::kDelay},
    {"DISPLAY", Word::kDisplay},
    {"DISPLY", Word::kDisplay},
    {"DWELL", Word::kDelay},
    {"END", Word::kEnd},
    {"END-OF-PATH", Word::kEndOfPath},
    {"FEDRAT", Word::kFeed},
    {"FINI", Word::kFini},
    {"FROM", Word::kFrom},
    {"GODLTA", Word::kGoDelta},
    {"GOHOME", Word::kRefused},
    {"GOTO", Word::kGoto},
    {"HEAD", Word::kRefused},
    {"INDEX", Word::kRefused},
    {"INDIRV", Word::kForward},
    {"INSERT", Word::kInsert},
    {"INTOL", Word::kSilent},
    {"ISN", Word::kSilent},
    {"LEADER", Word::kSkipped},
    {"LETTER", Word::kSilent},
    {"LINTOL", Word::kSkipped},
    {"LOAD", Word::kLoad},
    {"LOADTL", Word::kLoadTool},
    {"LPRINT", Word::kSilent},
    {"MACHIN", Word::kSilent},
    {"MODE", Word::kSet},
    {"MOVARC", Word::kRefused},
    {"MSYS", Word::kMsys},
    {"MULTAX", Word::kSilent},
    {"NOPOST", Word::kSilent},
    {"NURBS", Word::kRefused},
    {"OPSKIP", Word::kSkipped},
    {"OPSTOP", Word::kOptionStop},
    {"ORIGIN", Word::kOrigin},
    {"OUTTOL", Word::kSilent},
    {"PAINT", Word::kDisplay},
    {"PARTNO", Word::kProgram},
    {"PIVOTZ", Word::kSkipped},
    {"PLOT", Word::kDisplay},
    {"PPFUN", Word::kSkipped},
    {"PPRINT", Word::kNote},
    {"PPWORD", Word::kSilent},
    {"PREFUN", Word::kVendor},
    {"PSIS", Word::kSilent},
    {"RAPID", Word::kRapid},
    {"REMARK", Word::kSilent},
    {"RESERV", Word::kSilent},
    {"ROTABL", Word::kRefused},
    {"ROTATE", Word::kRefused},
    {"ROTHED", Word::kRefused},
    {"SELCTL", Word::kSilent},
    {"SELECT", Word::kSilent},
    {"SEQNO", Word::kSkipped},
    {"SET", Word::kSet},
    {"SPINDL", Word::kSpindle},
    {"SPLINE", Word::kRefused},
    {"STOP", Word::kStop},
    {"SYN", Word::kSilent},
    {"THREAD", Word::kRefused},
    {"TITLES", Word::kSilent},
    {"TLAXIS", Word::kToolAxis},
    {"TLDATA", Word::kToolData},
    {"TLON", Word::kToolOn},
    {"TOLER", Word::kSilent},
    {"TOOL PATH", Word::kToolPath},
    {"TOOLNO", Word::kSilent},
    {"TPRINT", Word::kSilent},
    {"TRACUT", Word::kRefused},
    {"TRANS", Word::kRefused},
    {"TRNTYP", Word::kTransform},
    {"UNIT", Word::kUnits},
    {"UNITS", Word::kUnits},
    {"VTLAXS", Word::kSkipped},
});
static_assert(std::is_sorted(kTable.begin(), kTable.end(),
                             [](const Entry& a, const Entry& b) { return a.text < b.text; }));

struct Reason {
  std::string_view text;
  std::string_view reason;
};

constexpr std::array kReasons = std::to_array<Reason>({
    {"CALL", "calls a macro whose motion is not in this file"},
    {"CALSUB", "calls a subprogram whose motion is not in this file"},
    {"COPY", "repeats motion under a transformation; write the repeated motion out"},
    {"GOHOME", "moves to a position of the machine that the file does not tell"},
    {"HEAD", "selects another head"},
    {"INDEX", "repeats motion under a transformation; write the repeated motion out"},
    {"MOVARC", "is arc motion in a form that is not understood; output CIRCLE or points"},
    {"NURBS", "is spline motion; output points or arcs"},
    {"ROTABL", "turns a rotary axis itself; output the tool axis with every GOTO"},
    {"ROTATE", "turns a rotary axis itself; output the tool axis with every GOTO"},
    {"ROTHED", "turns a rotary axis itself; output the tool axis with every GOTO"},
    {"SPLINE", "is spline motion; output points or arcs"},
    {"THREAD", "is motion tied to the spindle angle"},
    {"TRACUT", "transforms the points behind it; output them transformed"},
    {"TRANS", "shifts the points behind it; output them shifted"},
});

}  // namespace

Word find_word(std::string_view major) noexcept {
  if (major == "GOTO") return Word::kGoto;  // nearly every statement
  const auto* const at =
      std::lower_bound(kTable.begin(), kTable.end(), major,
                       [](const Entry& entry, std::string_view text) { return entry.text < text; });
  if (at != kTable.end() && at->text == major) return at->word;
  return major.starts_with("CSI_") ? Word::kSkipped : Word::kUnknown;
}

std::string_view refusal(std::string_view major) noexcept {
  const auto* const at = std::find_if(kReasons.begin(), kReasons.end(),
                                      [major](const Reason& r) { return r.text == major; });
  return at != kReasons.end() ? at->reason : std::string_view{};
}

}  // namespace meridian::cl
