// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/siemens/siemens_names.hpp"

#include <algorithm>
#include <array>

#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/siemens/siemens_cycles.hpp"
#include "service/programs/nc/siemens/siemens_frames.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

enum class What : std::uint8_t {
  kOn,           ///< TRAORI
  kOff,          ///< TRAFOOF
  kGreatCircle,  ///< ORIVECT
  kEvenJoints,   ///< ORIAXES
  kPart,         ///< ORIWKS: directions of the part
  kMachine,      ///< ORIMKS
  kMachinePlace,
  kNothing,
  kFrame,
  kModalCall,  ///< MCALL
  kRefused
};

struct NameRow {
  std::string_view name;
  What what;
  std::string_view note = {};
};

constexpr std::string_view kMacro = "variables, jumps and subprograms are not run here";
constexpr std::string_view kCone = "a way of the tool axis that is no great circle";
constexpr std::string_view kCurve = "a spline of the control";

constexpr std::array kNames = std::to_array<NameRow>({
    {"TRAORI", What::kOn},
    {"TRAFOOF", What::kOff},
    {"ORIVECT", What::kGreatCircle},
    {"ORIPLANE", What::kGreatCircle},
    {"ORIAXES", What::kEvenJoints},
    {"ORIWKS", What::kPart},
    {"ORIWCS", What::kPart},
    {"ORIMKS", What::kMachine},
    {"ORIMCS", What::kMachine},
    {"SUPA", What::kMachinePlace},
    {"ACC", What::kNothing},
    {"ADIS", What::kNothing},
    {"ADISPOS", What::kNothing},
    {"ATOL", What::kNothing},
    {"BRISK", What::kNothing},
    {"CDOF", What::kNothing},
    {"CDOF2", What::kNothing},
    {"CDON", What::kNothing},
    {"CFC", What::kNothing},
    {"CFIN", What::kNothing},
    {"CFTCP", What::kNothing},
    {"COMPCAD", What::kNothing},
    {"COMPCURV", What::kNothing},
    {"COMPOF", What::kNothing},
    {"COMPON", What::kNothing},
    {"COMPSURF", What::kNothing},
    {"CPRECOF", What::kNothing},
    {"CPRECON", What::kNothing},
    {"CTOL", What::kNothing},
    {"CUT2D", What::kNothing},
    {"CUT2DF", What::kNothing},
    {"CUT3DC", What::kNothing},
    {"CUT3DF", What::kNothing},
    {"CYCLE832", What::kNothing},
    {"DIAMOF", What::kNothing},
    {"DRIVE", What::kNothing},
    {"DYNFINISH", What::kNothing},
    {"DYNNORM", What::kNothing},
    {"DYNPOS", What::kNothing},
    {"DYNPREC", What::kNothing},
    {"DYNROUGH", What::kNothing},
    {"DYNSEMIFIN", What::kNothing},
    {"FFWOF", What::kNothing},
    {"FFWON", What::kNothing},
    {"FGREF", What::kNothing},
    {"FGROUP", What::kNothing},
    {"FIFOCTRL", What::kNothing},
    {"FIFOLEN", What::kNothing},
    {"FNORM", What::kNothing},
    {"GROUP_BEGIN", What::kNothing},
    {"GROUP_END", What::kNothing},
    {"JERKLIM", What::kNothing},
    {"KONT", What::kNothing},
    {"LIMS", What::kNothing},
    {"MSG", What::kNothing},
    {"NORM", What::kNothing},
    {"ORIEULER", What::kNothing},
    {"ORIRPY", What::kNothing},
    {"ORIRPY2", What::kNothing},
    {"ORISOF", What::kNothing},
    {"ORISON", What::kNothing},
    {"OTOL", What::kNothing},
    {"PAROTOF", What::kNothing},
    {"RTLIOF", What::kNothing},
    {"RTLION", What::kNothing},
    {"SBLOF", What::kNothing},
    {"SBLON", What::kNothing},
    {"SETMS", What::kNothing},
    {"SOFT", What::kNothing},
    {"STARTFIFO", What::kNothing},
    {"STOLF", What::kNothing},
    {"STOPFIFO", What::kNothing},
    {"STOPRE", What::kNothing},
    {"TOFFOF", What::kNothing},
    {"TOROTOF", What::kNothing},
    {"UPATH", What::kNothing},
    {"VELOLIM", What::kNothing},
    {"WORKPIECE", What::kNothing},
    {"CYCLE800", What::kFrame},
    {"TRANS", What::kFrame},
    {"ATRANS", What::kFrame},
    {"ROT", What::kFrame},
    {"AROT", What::kFrame},
    {"ROTS", What::kFrame},
    {"AROTS", What::kFrame},
    {"MIRROR", What::kFrame},
    {"AMIRROR", What::kFrame},
    {"SCALE", What::kFrame},
    {"ASCALE", What::kFrame},
    {"ORICONCW", What::kRefused, kCone},
    {"ORICONCCW", What::kRefused, kCone},
    {"ORICONIO", What::kRefused, kCone},
    {"ORICONTO", What::kRefused, kCone},
    {"ORICURVE", What::kRefused, kCone},
    {"ASPLINE", What::kRefused, kCurve},
    {"BSPLINE", What::kRefused, kCurve},
    {"CSPLINE", What::kRefused, kCurve},
    {"POLY", What::kRefused, kCurve},
    {"CIP", What::kRefused, "an arc by a point between"},
    {"CT", What::kRefused, "a tangent arc"},
    {"MEAS", What::kRefused, "probing: where it ends only the machine knows"},
    {"MEAW", What::kRefused, "probing: where it ends only the machine knows"},
    {"CALL", What::kRefused, kMacro},
    {"CASE", What::kRefused, kMacro},
    {"ELSE", What::kRefused, kMacro},
    {"ENDFOR", What::kRefused, kMacro},
    {"ENDIF", What::kRefused, kMacro},
    {"ENDLOOP", What::kRefused, kMacro},
    {"ENDWHILE", What::kRefused, kMacro},
    {"EXTCALL", What::kRefused, kMacro},
    {"FOR", What::kRefused, kMacro},
    {"GOTO", What::kRefused, kMacro},
    {"GOTOB", What::kRefused, kMacro},
    {"GOTOF", What::kRefused, kMacro},
    {"IF", What::kRefused, kMacro},
    {"LOOP", What::kRefused, kMacro},
    {"MCALL", What::kModalCall},
    {"PROC", What::kRefused, kMacro},
    {"REPEAT", What::kRefused, kMacro},
    {"RET", What::kRefused, kMacro},
    {"TRACYL", What::kRefused, "a transformation of the control"},
    {"TRANSMIT", What::kRefused, "a transformation of the control"},
    {"WHILE", What::kRefused, kMacro},
});

std::string printed(std::string_view name) { return std::string(name.substr(0, 24)); }

cl::Outcome take_unknown(State& s, const Line& line, const Line::Name& name) {
  const auto& allowed = s.cl.options.allowed_words;
  if (std::find(allowed.begin(), allowed.end(), name.name) != allowed.end()) {
    s.cl.path.vendor_word(printed(name.name).substr(0, 23), 0, line.number);
    return {};
  }
  return refuse(
      "the word " + printed(name.name) + " is not known here",
      "--allow-unknown " + printed(name.name) + " passes it to the machine as a vendor word",
      "unknown " + printed(name.name));
}

const NameRow* find_name(std::string_view name) {
  const auto at = std::find_if(kNames.begin(), kNames.end(),
                               [name](const NameRow& row) { return row.name == name; });
  return at == kNames.end() ? nullptr : &*at;
}

cl::Outcome refuse_row(const NameRow& row) {
  return refuse(std::string(row.name) + ": " + std::string(row.note), kMovesByCam,
                std::string(row.name));
}

cl::Outcome take_drilling(State& s, const Line::Name& name, NameOutcome& out) {
  const auto drilling = siemens_drilling(s, name);
  if (!drilling) return tl::make_unexpected(drilling.error());
  out.drilling = *drilling;
  using Holes = NameOutcome::Holes;
  out.holes = out.holes == Holes::kNoMore ? Holes::kAtEveryPoint : Holes::kHere;
  return {};
}

cl::Outcome take_name(State& s, const Line& line, const Line::Name& name, NameOutcome& out) {
  if (is_siemens_drilling(name.name)) return take_drilling(s, name, out);
  const NameRow* const row = find_name(name.name);
  if (row == nullptr) return take_unknown(s, line, name);
  switch (row->what) {
    case What::kOn:
      s.modes.is_oriented = true;
      return set_control(s, line, s.axes ? Control::kRotary : Control::kVector);
    case What::kOff:
      s.modes.is_oriented = false;
      return set_control(s, line, Control::kLength);
    case What::kGreatCircle:
    case What::kEvenJoints:
      s.modes.turns_evenly = row->what == What::kEvenJoints;
      return {};
    case What::kPart:
    case What::kMachine:
      s.modes.has_machine_axes = row->what == What::kMachine;
      return {};
    case What::kMachinePlace:
      out.has_machine_place = true;
      return {};
    case What::kNothing:
      s.cl.summary.skip(name.name, line.number);
      return {};
    case What::kFrame:
      out.has_frame = true;
      return take_siemens_frame(s, line, name);
    case What::kModalCall:
      out.holes = NameOutcome::Holes::kNoMore;
      return {};
    case What::kRefused:
      break;
  }
  return refuse_row(*row);
}

}  // namespace

cl::Outcome check_names(const Line& line) {
  for (const Line::Name& name : line.names) {
    const NameRow* const row = find_name(name.name);
    if (row != nullptr && row->what == What::kRefused) return refuse_row(*row);
    const bool is_cycle = name.name.starts_with("CYCLE") && row == nullptr;
    if (is_cycle && !is_siemens_drilling(name.name)) {
      return refuse(printed(name.name) + ": a cycle that only the control knows", kMovesByCam,
                    printed(name.name));
    }
  }
  return {};
}

Expected<NameOutcome, cl::Refusal> take_names(State& s, const Line& line) {
  NameOutcome out;
  for (const Line::Name& name : line.names) {
    if (auto done = take_name(s, line, name, out); !done) return tl::make_unexpected(done.error());
  }
  return out;
}

cl::Outcome check_siemens_addresses(const State& s, const Line& line) {
  if (const Word* const call = line.find("L")) {
    return refuse("L" + std::string(call->digits) + ": a subprogram, which is not run here",
                  "let the CAM system write one program without it", "L");
  }
  for (const Word& word : line.words) {
    const bool is_known = word.address.size() == 1 || !word.may_be_rotary() ||
                          (s.axes && s.axes->is_rotary(word.address));
    if (is_known) continue;
    return refuse("address " + printed(word.address) + "= is not understood",
                  "orientation as A3= B3= C3= or as rotary words", "address=");
  }
  return {};
}

}  // namespace meridian::nc
