// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/tip_box_file.hpp"

#include "meridian/kinematics/tip_over_base.hpp"

namespace meridian::config {

TipBox read_tip_box(Section& file, const MachineModel& model) {
  constexpr const char* kRemedy = "give X, Y, Z over the base, mm";
  if (!file.has("tip_box")) return {};
  Section section = file.section("tip_box");
  TipBox box{true, {}, {}};
  box.min = section.triple("min_mm", {-1e5, 1e5}, kRemedy);
  box.max = section.triple("max_mm", {-1e5, 1e5}, kRemedy);
  section.finish();
  if (!is_tip_box(box))
    section.refuse("max_mm", "above min_mm along each axis", "give both corners so");
  JointVector home{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    home[i] = model.joints[i].home;
  }
  if (axis_outside(box, tip_over_base(model, model.tool_length_mm, home)) >= 0) {
    section.refuse("min_mm", "a box that the tip is in at home", "widen it, or move home into it");
  }
  return box;
}

}  // namespace meridian::config
