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

constexpr std::string_view kMacro = "variables, jumps and subprograms are not run here";
constexpr std::string_view kCone = "a way of the tool axis that is no great circle";
constexpr std::string_view kCurve = "a spline of the control";
constexpr std::string_view kJoints = "every axis goes for itself, and the tip leaves the line";
constexpr std::string_view kCarrier = "a frame by a tool carrier, which only the control knows";
constexpr std::string_view kPattern = "a cycle that only the control knows";

constexpr std::array kNames = std::to_array<NameRow>({
    {"TRAORI", NameKind::kOn},
    {"TRAFOOF", NameKind::kOff},
    {"ORIVECT", NameKind::kGreatCircle},
    {"ORIPLANE", NameKind::kGreatCircle},
    {"ORIAXES", NameKind::kEvenJoints},
    {"ORIWKS", NameKind::kPart},
    {"ORIWCS", NameKind::kPart},
    {"ORIMKS", NameKind::kMachine},
    {"ORIMCS", NameKind::kMachine},
    {"SUPA", NameKind::kMachinePosition},
    {"ACC", NameKind::kNothing},
    {"ACCLIMA", NameKind::kNothing},
    {"ADIS", NameKind::kNothing},
    {"ADISPOS", NameKind::kNothing},
    {"ATOL", NameKind::kNothing},
    {"BRISK", NameKind::kNothing},
    {"CDOF", NameKind::kNothing},
    {"CDOF2", NameKind::kNothing},
    {"CDON", NameKind::kNothing},
    {"CFC", NameKind::kNothing},
    {"CFIN", NameKind::kNothing},
    {"CFTCP", NameKind::kNothing},
    {"CP", NameKind::kNothing},  // ends PTP
    {"COMPCAD", NameKind::kNothing},
    {"COMPCURV", NameKind::kNothing},
    {"COMPOF", NameKind::kNothing},
    {"COMPON", NameKind::kNothing},
    {"COMPSURF", NameKind::kNothing},
    {"CPRECOF", NameKind::kNothing},
    {"CPRECON", NameKind::kNothing},
    {"CTOL", NameKind::kNothing},
    {"CUT2D", NameKind::kNothing},
    {"CUT2DF", NameKind::kNothing},
    {"CUT3DC", NameKind::kNothing},
    {"CUT3DF", NameKind::kNothing},
    {"CYCLE832", NameKind::kNothing},
    {"DIAMOF", NameKind::kNothing},
    {"DRIVE", NameKind::kNothing},
    {"DYNFINISH", NameKind::kNothing},
    {"DYNNORM", NameKind::kNothing},
    {"DYNPOS", NameKind::kNothing},
    {"DYNPREC", NameKind::kNothing},
    {"DYNROUGH", NameKind::kNothing},
    {"DYNSEMIFIN", NameKind::kNothing},
    {"FFWOF", NameKind::kNothing},
    {"FFWON", NameKind::kNothing},
    {"FENDNORM", NameKind::kNothing},
    {"FGREF", NameKind::kNothing},
    {"FGROUP", NameKind::kNothing},
    {"FIFOCTRL", NameKind::kNothing},
    {"FIFOLEN", NameKind::kNothing},
    {"FL", NameKind::kNothing},
    {"FNORM", NameKind::kNothing},
    {"GROUP_BEGIN", NameKind::kNothing},
    {"GROUP_END", NameKind::kNothing},
    {"JERKLIM", NameKind::kNothing},
    {"JERKLIMA", NameKind::kNothing},
    {"KONT", NameKind::kNothing},
    {"LIMS", NameKind::kNothing},
    {"MSG", NameKind::kNothing},
    {"NORM", NameKind::kNothing},
    {"ORIEULER", NameKind::kNothing},
    {"ORIRPY", NameKind::kNothing},
    {"ORIRPY2", NameKind::kNothing},
    {"ORISOF", NameKind::kNothing},
    {"ORISON", NameKind::kNothing},
    {"OTOL", NameKind::kNothing},
    {"PAROTOF", NameKind::kNothing},
    {"RTLIOF", NameKind::kNothing},
    {"RTLION", NameKind::kNothing},
    {"SBLOF", NameKind::kNothing},
    {"SBLON", NameKind::kNothing},
    {"SETMS", NameKind::kNothing},
    {"SOFT", NameKind::kNothing},
    {"SPATH", NameKind::kNothing},
    {"STARTFIFO", NameKind::kNothing},
    {"STOLF", NameKind::kNothing},
    {"STOPFIFO", NameKind::kNothing},
    {"STOPRE", NameKind::kNothing},
    {"TOFFOF", NameKind::kNothing},
    {"TOROTOF", NameKind::kNothing},
    {"UPATH", NameKind::kNothing},
    {"VELOLIM", NameKind::kNothing},
    {"VELOLIMA", NameKind::kNothing},
    {"WALIMOF", NameKind::kNothing},
    {"WALIMON", NameKind::kNothing},
    {"WORKPIECE", NameKind::kNothing},
    {"CYCLE800", NameKind::kFrame},
    {"TRANS", NameKind::kFrame},
    {"ATRANS", NameKind::kFrame},
    {"ROT", NameKind::kFrame},
    {"AROT", NameKind::kFrame},
    {"ROTS", NameKind::kFrame},
    {"AROTS", NameKind::kFrame},
    {"MIRROR", NameKind::kFrame},
    {"AMIRROR", NameKind::kFrame},
    {"SCALE", NameKind::kFrame},
    {"ASCALE", NameKind::kFrame},
    {"ORICONCW", NameKind::kRefused, kCone},
    {"ORICONCCW", NameKind::kRefused, kCone},
    {"ORICONIO", NameKind::kRefused, kCone},
    {"ORICONTO", NameKind::kRefused, kCone},
    {"ORICURVE", NameKind::kRefused, kCone},
    {"ASPLINE", NameKind::kRefused, kCurve},
    {"BSPLINE", NameKind::kRefused, kCurve},
    {"CSPLINE", NameKind::kRefused, kCurve},
    {"POLY", NameKind::kRefused, kCurve},
    {"CIP", NameKind::kRefused, "an arc by a point between"},
    {"CT", NameKind::kRefused, "a tangent arc"},
    {"PTP", NameKind::kRefused, kJoints},
    {"PTPG0", NameKind::kRefused, kJoints},
    {"PAROT", NameKind::kRefused, kCarrier},
    {"TCOABS", NameKind::kRefused, kCarrier},
    {"TCOFR", NameKind::kRefused, kCarrier},
    {"TOFRAME", NameKind::kRefused, kCarrier},
    {"TOROT", NameKind::kRefused, kCarrier},
    {"TOFFON", NameKind::kRefused, "a shift along the tool while the program runs"},
    {"HOLES1", NameKind::kRefused, kPattern},
    {"HOLES2", NameKind::kRefused, kPattern},
    {"LONGHOLE", NameKind::kRefused, kPattern},
    {"POCKET3", NameKind::kRefused, kPattern},
    {"POCKET4", NameKind::kRefused, kPattern},
    {"SLOT1", NameKind::kRefused, kPattern},
    {"SLOT2", NameKind::kRefused, kPattern},
    {"ORIRESET", NameKind::kRefused, "turns the tool to where the machine has its begin"},
    {"MEAS", NameKind::kRefused, "probing: where it ends only the machine knows"},
    {"MEAW", NameKind::kRefused, "probing: where it ends only the machine knows"},
    {"CALL", NameKind::kRefused, kMacro},
    {"CASE", NameKind::kRefused, kMacro},
    {"ELSE", NameKind::kRefused, kMacro},
    {"ENDFOR", NameKind::kRefused, kMacro},
    {"ENDIF", NameKind::kRefused, kMacro},
    {"ENDLOOP", NameKind::kRefused, kMacro},
    {"ENDWHILE", NameKind::kRefused, kMacro},
    {"EXTCALL", NameKind::kRefused, kMacro},
    {"FOR", NameKind::kRefused, kMacro},
    {"GOTO", NameKind::kRefused, kMacro},
    {"GOTOB", NameKind::kRefused, kMacro},
    {"GOTOF", NameKind::kRefused, kMacro},
    {"IF", NameKind::kRefused, kMacro},
    {"LOOP", NameKind::kRefused, kMacro},
    {"MCALL", NameKind::kModalCall},
    {"PROC", NameKind::kRefused, kMacro},
    {"REPEAT", NameKind::kRefused, kMacro},
    {"RET", NameKind::kRefused, kMacro},
    {"TRAANG", NameKind::kRefused, "a transformation of the control"},
    {"TRACYL", NameKind::kRefused, "a transformation of the control"},
    {"TRANSMIT", NameKind::kRefused, "a transformation of the control"},
    {"WHILE", NameKind::kRefused, kMacro},
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

/// FGROUP(X,Y): F counts along these axes alone.
void warn_of_feed_group(State& s, const Line& line, const Line::Name& name) {
  if (name.name != "FGROUP") return;
  std::string axes;
  for (const char c : name.arguments) {
    if (cl::is_letter(c)) axes += c;
  }
  std::sort(axes.begin(), axes.end());
  if (axes.empty() || axes == "XYZ") return;
  s.cl.remarks.warn("FGROUP", line.number, [&name] {
    return "FGROUP(" + std::string(name.arguments.substr(0, 24)) +
           "): F is taken as the feed of the tip along X, Y and Z; the control counts these axes";
  });
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
  switch (row->kind) {
    case NameKind::kOn:
      s.modes.orientation.transformation = Orientation::Transformation::kOn;
      return set_control(s, line, s.axes ? Control::kRotary : Control::kVector);
    case NameKind::kOff:
      s.modes.orientation.transformation = Orientation::Transformation::kOff;
      return set_control(s, line, Control::kLength);
    case NameKind::kGreatCircle:
      s.modes.orientation.between = Orientation::Between::kGreatCircle;
      return {};
    case NameKind::kEvenJoints:
      s.modes.orientation.between = Orientation::Between::kEvenJoints;
      return {};
    case NameKind::kPart:
      s.modes.orientation.axes = Orientation::Axes::kOfPart;
      return {};
    case NameKind::kMachine:
      s.modes.orientation.axes = Orientation::Axes::kOfMachine;
      return {};
    case NameKind::kMachinePosition:
      out.has_machine_position = true;
      return {};
    case NameKind::kNothing:
      s.cl.summary.skip(name.name, line.number);
      warn_of_feed_group(s, line, name);
      return {};
    case NameKind::kFrame:
      out.has_frame = true;
      return take_siemens_frame(s, line, name);
    case NameKind::kModalCall:
      out.holes = NameOutcome::Holes::kNoMore;
      return {};
    case NameKind::kRefused:
      break;
  }
  return refuse_row(*row);
}

}  // namespace

std::span<const NameRow> name_rows() noexcept { return kNames; }

cl::Outcome check_names(const Line& line) {
  for (const Line::Name& name : line.names) {
    const NameRow* const row = find_name(name.name);
    if (row != nullptr && row->kind == NameKind::kRefused) return refuse_row(*row);
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
    constexpr std::string_view kOfSpindles = "SM";
    if (kOfSpindles.find(word.address.front()) != std::string_view::npos) {
      return refuse(printed(word.address) + "= is of another spindle, which is not run here",
                    "output the words of the spindle that cuts alone", "other spindle");
    }
    return refuse("address " + printed(word.address) + "= is not understood",
                  "orientation as A3= B3= C3= or as rotary words", "address=");
  }
  return {};
}

}  // namespace meridian::nc
