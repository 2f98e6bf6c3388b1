// SPDX-License-Identifier: Apache-2.0
// Codes that change what points mean: tool-centre control, work offset, unit.
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr int kPerRow = 10000, kPreset = 2470;

/// Its number among the work frames of the machine: G54 to G59 and G59.1 to G59.3 are 1 to 9, G54.1
/// P1 is 7; G505 of Siemens is 5, a preset of Klartext has its own. 0: none.
int frame_of(int offset) {
  constexpr int kFirst = 540, kOfTable = 541, kTenthsPerCode = 10;
  const int row = offset / kPerRow, code = offset % kPerRow;
  if (code == kPreset) return row;
  if (code == kOfTable) return 6 + row;
  if (code > 590 && code <= 593) return 6 + (code - 590);
  if (code >= kFirst && code <= 590) return 1 + (code - kFirst) / kTenthsPerCode;
  if (code > 5000 && code <= 5990) return (code - 5000) / kTenthsPerCode;
  return 0;
}

/// "G54", "G59.3", "G54.1 P12", "CYCL DEF 247 Q339=2".
std::string name_of(int offset) {
  const int code = offset % kPerRow;
  if (code == kPreset) return "CYCL DEF 247 Q339=" + std::to_string(offset / kPerRow);
  std::string name = "G" + std::to_string(code / 10);
  if (code % 10 != 0) name += "." + std::to_string(code % 10);
  if (offset >= kPerRow) name += " P" + std::to_string(offset / kPerRow);
  return name;
}

void note_offset(State& s, const std::string& name) {
  std::string& all = s.cl.summary.nc.work_offset;
  if (!s.cl.path.has_moved()) all.clear();
  const bool is_there = (", " + all + ",").find(", " + name + ",") != std::string::npos;
  if (!is_there) all += (all.empty() ? "" : ", ") + name;
}

/// Where its zero lies, from that of the station's frame; nothing: only the control knows.
std::optional<Vector3> zero_of(const State& s, int offset) {
  const auto& known = s.cl.options.work_offsets;
  const auto at = known.find(frame_of(offset));
  if (!s.axes || at == known.end()) return std::nullopt;
  return Vector3(at->second - s.axes->zero_mm());
}

/// G500 of Siemens takes every offset out of force: no frame of the machine has its zero.
std::string remedy_of_unknown(int offset) {
  const int frame = frame_of(offset);
  if (frame == 0) {
    return "write " + name_of(offset) +
           " after the last motion alone; for a place of the machine SUPA with axis words";
  }
  return "--work-zero " + std::to_string(frame) +
         "=X,Y,Z, or ctl frame set; or split the program: one for each";
}

/// A program of G54 under frame 2 is not cut where the operator may expect it.
void warn_of_other_frame(State& s, const Line& line, int offset, const Vector3& zero_mm) {
  if (zero_mm.isZero(0)) return;
  s.cl.remarks.warn(name_of(offset), line.number, [&] {
    return name_of(offset) + " is not the work frame in force: its points lie " +
           cl::short_number(zero_mm.x()) + ", " + cl::short_number(zero_mm.y()) + ", " +
           cl::short_number(zero_mm.z()) + " mm (X, Y, Z) from there";
  });
}

/// It holds from the next motion on. One that is not known is the station's frame.
void take_offset(State& s, const Line& line, int offset) {
  if (s.modes.work_offset == offset) return;
  s.modes.work_offset = offset;
  const auto zero_mm = zero_of(s, offset);
  s.cl.summary.nc.has_work_zero = zero_mm.has_value();
  if (!s.cl.path.has_moved()) note_offset(s, name_of(offset));
  if (!zero_mm && s.cl.path.has_moved()) return;
  if (zero_mm) warn_of_other_frame(s, line, offset, *zero_mm);
  set_zero(s, line, zero_mm.value_or(Vector3::Zero()));
}

}  // namespace

cl::Outcome set_control(State& s, const Line& line, Control control) {
  if (holds_tip(control) && s.modes.has_dynamic_offset) {
    return refuse("tool-centre control under G254", "write G255 before it");
  }
  const Control before = s.modes.control;
  s.modes.control = control;
  if (before == control) return {};
  const bool was_on = holds_tip(before), is_on = holds_tip(control);
  if ((was_on || is_on) && s.position.is_turned()) s.position.forget();
  // The length of the tool counts from here, or ends.
  const bool has_bare = before == Control::kNone || control == Control::kNone;
  if (was_on != is_on && has_bare) s.position.tip[2].reset();
  if (control == Control::kVector) s.position.vector.reset();
  const bool has_no_word = s.position.rotary.empty() && !s.position.is_by_control;
  if (control == Control::kRotary && has_no_word) {
    s.cl.remarks.warn("rotary zero", line.number, [] {
      return "tool-centre control before any rotary word: the rotary axes are taken to stand at "
             "zero";
    });
  }
  return {};
}

cl::Outcome take_length(State& s, const Line& line, Control control) {
  const Word* const h = line.find("H");
  if (h == nullptr || control == Control::kNone) return set_control(s, line, control);
  if (h->number == 0) {
    if (!holds_tip(control)) return set_control(s, line, Control::kNone);
    return refuse("H0: tool-centre control without the length of the tool",
                  "write H with the number of the tool");
  }
  if (s.cl.tool && h->number != *s.cl.tool) {
    s.cl.remarks.warn("H", line.number, [&] {
      return "H" + std::string(h->digits) + " beside tool " + std::to_string(*s.cl.tool) +
             ": the length is that of the tool; the control takes it from offset " +
             std::string(h->digits);
    });
  }
  return set_control(s, line, control);
}

cl::Outcome set_work_offset(State& s, const Line& line, int tenths) {
  constexpr int kOfTable = 541, kOfTableOfHaas = 1540;
  int offset = tenths;
  if (tenths == kOfTable || tenths == kOfTableOfHaas) {
    const Word* const p = line.find("P");
    const bool is_whole = p != nullptr && p->number >= 1 && p->number <= 999 &&
                          p->number == static_cast<int>(p->number);
    if (!is_whole) return refuse("G54.1 and G154 need their number, such as P1");
    offset = kOfTable + kPerRow * static_cast<int>(p->number);
  }
  take_offset(s, line, offset);
  return {};
}

void set_preset(State& s, const Line& line, int row) {
  take_offset(s, line, kPreset + kPerRow * row);
}

cl::Outcome check_work_offset(State& s, const Line& line) {
  const int from = s.modes.moved_offset, to = s.modes.work_offset;
  if (from == to || !s.cl.path.has_moved()) {
    s.modes.moved_offset = to;
    return {};
  }
  constexpr int kFirst = 540;
  if (from == 0 && !(to == kFirst && s.modes.language == Language::kFanuc)) {
    return refuse(name_of(to) +
                      " after motion without a work offset: where that was only the "
                      "control knows",
                  "name the work offset before the first motion", "second offset");
  }
  if (from == 0) {
    s.cl.remarks.warn("late offset", line.number, [] {
      return std::string("G54 after motion without a work offset: that is taken to lie in G54 too");
    });
  } else if (!zero_of(s, to) || !zero_of(s, from)) {
    const int missing = zero_of(s, to) ? from : to;
    return refuse("a second work offset (" + name_of(to) + " after " + name_of(from) + "): where " +
                      name_of(missing) + " lies only the control knows",
                  remedy_of_unknown(missing), "second offset");
  }
  note_offset(s, name_of(to));
  s.modes.moved_offset = to;
  return {};
}

cl::Outcome set_unit(State& s, cl::LengthUnit unit) {
  if (s.cl.units.in_force && *s.cl.units.in_force != unit && !s.cl.options.unit) {
    return refuse("the unit changes after the first motion", "split the program");
  }
  s.cl.units.stated = unit;
  return {};
}

}  // namespace meridian::nc
