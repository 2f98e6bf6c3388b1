// SPDX-License-Identifier: Apache-2.0
// G254 of Haas, the dynamic work offset: the zero of the program goes with the table, X Y Z stay
// along the machine's axes. It is a tilted plane that the rotary words define.
#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr double kSameTool = 1e-6;  // of the distance between two unit vectors

/// The plane across the tool with the rotary axes there.
Expected<cl::Frame, cl::Refusal> plane_of_table(const State& s, const ToolPosition& position) {
  if (!s.axes) {
    return refuse(
        "G254 needs the machine that it is written for: which axes turn the table is in "
        "its machine file",
        "--machine FILE", "machine");
  }
  if (!s.axes->refusal().empty()) return refuse(s.axes->refusal(), kRightMachine, "machine");
  if (position.is_by_control) {
    return refuse("G254, but no word says where the control turned the rotary axes (G53.1)",
                  "write all rotary words before it", "not given");
  }
  const auto axes_in_w = s.axes->linear_axes(position.rotary);
  if (!axes_in_w) return refuse("G254 needs a machine with the axes X, Y and Z", kRightMachine);
  cl::Frame plane;
  plane.rotation = s.axes->to_program() * *axes_in_w;
  const Vector3 tool = s.axes->to_program() * s.axes->axis(position.rotary);
  if ((plane.rotation.col(2) - tool).norm() > kSameTool) {
    return refuse(
        "G254 on a machine whose rotary axes turn the tool: X Y Z are not those of its "
        "tip",
        "output G234, or G43.4", "G254");
  }
  return plane;
}

}  // namespace

cl::Outcome begin_dynamic_offset(State& s, const Line& line) {
  if (holds_tip(s.modes.control)) {
    return refuse("G254 while tool-centre control is on", "write G49 before it");
  }
  if (s.frames.tilt != Tilt::kNone && !s.modes.has_dynamic_offset) {
    return refuse("G254 in a tilted plane", "write G69 before it");
  }
  const auto plane = plane_of_table(s, s.position);
  if (!plane) return tl::make_unexpected(plane.error());
  s.modes.has_dynamic_offset = true;
  set_plane(s, line, *plane, Tilt::kDefined);
  return {};
}

void end_dynamic_offset(State& s, const Line& line) {
  if (!s.modes.has_dynamic_offset) {
    s.cl.summary.skip("G255", line.number);
    return;
  }
  s.modes.has_dynamic_offset = false;
  set_plane(s, line, {}, Tilt::kNone);
}

cl::Outcome turn_with_table(State& s, const Line& line, Target& to) {
  if (s.modes.motion != Motion::kRapid) {
    return refuse("a cut in which rotary axes turn under G254",
                  "output G234, under which X Y Z are those of the tip", "G254");
  }
  if (s.modes.is_incremental())
    return refuse("rotary words under G254 and G91", "write G90 before");
  const auto plane = plane_of_table(s, to.position);
  if (!plane) return tl::make_unexpected(plane.error());
  set_plane(s, line, *plane, Tilt::kDefined);
  // An axis that the block leaves out stands still while the zero goes on with the table.
  constexpr std::array<std::string_view, 3> kTip = {"X", "Y", "Z"};
  for (std::size_t k = 0; k < kTip.size(); ++k) {
    if (line.find(kTip[k]) == nullptr) to.position.tip[k].reset();
  }
  to.turns = false;
  if (!s.cl.path.has_moved()) return {};
  s.cl.remarks.warn("table", line.number, [] {
    return std::string(
        "the table turns under G254: how the tip goes over the part meanwhile is not followed; the "
        "next motion goes straight from the point before; see that nothing is in the way");
  });
  return {};
}

}  // namespace meridian::nc
