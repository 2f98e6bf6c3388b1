// SPDX-License-Identifier: Apache-2.0
// Codes that change what points mean: tool-centre control, work offset, unit.
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr int kPerRow = 10000, kPreset = 2470;

/// "G54", "G59.3", "G54.1 P12", "CYCL DEF 247 Q339=2".
std::string name_of(int offset) {
  const int code = offset % kPerRow;
  if (code == kPreset) return "CYCL DEF 247 Q339=" + std::to_string(offset / kPerRow);
  std::string name = "G" + std::to_string(code / 10);
  if (code % 10 != 0) name += "." + std::to_string(code % 10);
  if (offset >= kPerRow) name += " P" + std::to_string(offset / kPerRow);
  return name;
}

cl::Outcome take_offset(State& s, int offset) {
  if (s.modes.work_offset != 0 && s.modes.work_offset != offset && s.cl.path.has_moved()) {
    return refuse("a second work offset (" + name_of(offset) + " behind " +
                      name_of(s.modes.work_offset) +
                      "): how far the two are apart only the control knows",
                  "split the program: one for each", "second offset");
  }
  s.modes.work_offset = offset;
  s.cl.summary.nc.work_offset = name_of(offset);
  return {};
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
  if ((was_on || is_on) && s.place.is_turned()) s.place.forget();
  // The length of the tool counts from here, or ends.
  const bool has_bare = before == Control::kNone || control == Control::kNone;
  if (was_on != is_on && has_bare) s.place.tip[2].reset();
  if (control == Control::kVector) s.place.has_vector = false;
  if (control == Control::kRotary && s.place.rotary.empty()) {
    s.cl.remarks.warn("rotary zero", line.number, [] {
      return "tool-centre control before any rotary word: the rotary axes are taken to stand at "
             "zero";
    });
  }
  return {};
}

cl::Outcome set_work_offset(State& s, const Line& line, int tenths) {
  int offset = tenths;
  if (tenths == 541) {
    const Word* const p = line.find("P");
    const bool is_whole = p != nullptr && p->number >= 1 && p->number <= 999 &&
                          p->number == static_cast<int>(p->number);
    if (!is_whole) return refuse("G54.1 needs its number, such as P1");
    offset += kPerRow * static_cast<int>(p->number);
  }
  return take_offset(s, offset);
}

cl::Outcome set_preset(State& s, int row) { return take_offset(s, kPreset + kPerRow * row); }

cl::Outcome set_unit(State& s, cl::LengthUnit unit) {
  if (s.cl.units.in_force && *s.cl.units.in_force != unit && !s.cl.options.unit) {
    return refuse("the unit changes behind the first motion", "split the program");
  }
  s.cl.units.told = unit;
  return {};
}

}  // namespace meridian::nc
