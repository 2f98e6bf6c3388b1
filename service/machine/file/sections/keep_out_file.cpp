// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/keep_out_file.hpp"

#include <algorithm>
#include <string>

#include "meridian/units.hpp"

namespace meridian::config {
namespace {

void read_name(Section& section, const KeepOut& others, KeepOutBox& box) {
  const std::string name = section.text("name", "say what stands there");
  if (name.size() > kKeepOutNameChars) {
    section.refuse("name", "at most " + std::to_string(kKeepOutNameChars) + " characters",
                   "shorten it");
  }
  std::copy(name.begin(), name.end(), box.name.begin());
  const auto boxes = others.boxes();
  const bool is_taken = std::any_of(boxes.begin(), boxes.end(), [&box](const KeepOutBox& other) {
    return other.name == box.name;
  });
  if (is_taken) section.refuse("name", "a name of its own", "rename one of the two");
}

void read_interval(Section& section, const MachineModel& model, int joint, KeepOutBox& box) {
  const auto n = static_cast<std::size_t>(joint);
  const JointSpec& spec = model.joints[n];
  const std::string key = spec.name + (spec.is_rotary ? "_deg" : "_mm");
  if (!section.has(key)) return;
  const auto [low, high] = section.pair(key, {-1e5, 1e5}, "give [minimum, maximum]");
  if (!(low < high)) section.refuse(key, "minimum below maximum", "swap the two numbers");
  if (spec.is_endless) {
    section.refuse(key, "a joint with travel", spec.name + " is endless: name other joints");
  }
  const double unit = spec.is_rotary ? units::kDegree_rad : 1.0;
  box.joints |= 1U << static_cast<unsigned>(joint);
  box.min[n] = low * unit;
  box.max[n] = high * unit;
}

}  // namespace

KeepOut read_keep_out(Section& file, const MachineModel& model) {
  KeepOut out;
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) home[i] = model.joints[i].home;
  for (Section& section : file.sections_or("keep_out")) {
    KeepOutBox box;
    read_name(section, out, box);
    for (int i = 0; i < model.joint_count; ++i) read_interval(section, model, i, box);
    section.finish();
    if (box.joints == 0) {
      section.refuse("name", "a box with at least one joint",
                     "give JOINT_mm or JOINT_deg = [minimum, maximum]");
    }
    if (depth_inside(box, home) > kKeepOutRounding) {
      section.refuse("name", "a box beside home", "move the box, or home out of it");
    }
    if (!out.add(box)) {
      section.refuse("name", "at most " + std::to_string(KeepOut::kMax) + " boxes",
                     "put two of them into one");
    }
  }
  return out;
}

}  // namespace meridian::config
