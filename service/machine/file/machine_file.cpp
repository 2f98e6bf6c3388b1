// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/machine_file.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "meridian/units.hpp"
#include "service/machine/file/machine_name.hpp"
#include "service/machine/file/section.hpp"
#include "service/machine/file/sections/homing_file.hpp"
#include "service/machine/file/sections/keep_out_file.hpp"
#include "service/machine/file/sections/kinematics_file.hpp"
#include "service/machine/file/sections/mesh_file.hpp"
#include "service/machine/file/sections/monitoring_file.hpp"
#include "service/machine/file/sections/positions_file.hpp"
#include "service/machine/file/sections/stage_file.hpp"
#include "service/machine/file/sections/tip_box_file.hpp"

namespace meridian::config {
namespace {

void read_machine(Section machine, MachineModel& model) {
  model.name = machine.text("name", "name the machine; the DDS partition takes the name");
  if (!is_machine_name(model.name)) {
    machine.refuse("name", kMachineNameWords, "name the machine otherwise");
  }
  model.version = machine.text_or("version", "");
  model.cycle_ns =
      static_cast<std::int64_t>(std::llround(1e3 * machine.number("cycle_us", {125, 4000})));
  switch (machine.choice_or("default_unit", 0, {"none", "mm", "inch"})) {
    case 1:
      model.default_unit_mm = true;
      break;
    case 2:
      model.default_unit_inch = true;
      break;
    default:
      break;
  }
  model.max_feed_mm_per_s =
      units::per_s_from_per_min(machine.number("max_feed_mm_per_min", {1e-3, 1e6}));
  model.approach_feed_mm_per_s =
      units::per_s_from_per_min(machine.number("approach_feed_mm_per_min", {1e-3, 1e6}));
  model.clearance_mm = machine.number("clearance_mm", {0, 1e4});
  model.starve_auto_resume_s = machine.number_or("starve_auto_resume_s", 2.0, {0, 3600});
  model.bridge_cycles = machine.integer_or("bridge_cycles", 3, 0, 1000);
  model.tool_length_mm = machine.number("tool_length_mm", {0, 1e4});
  model.override_ramp_s = machine.number_or("override_ramp_s", 1.0, {1, 1000});
  model.max_feed_override = machine.number_or("feed_override_max_percent", 150, {100, 200}) / 100;
  machine.finish();
}

/// The keys of a joint, in mm or in deg.
struct JointKeys {
  std::string travel, velocity, acceleration, jerk, fault_acceleration, fault_jerk, following_error,
      home;

  explicit JointKeys(const std::string& unit)
      : travel("travel_" + unit),
        velocity("velocity_" + unit + "_per_s"),
        acceleration("acceleration_" + unit + "_per_s2"),
        jerk("jerk_" + unit + "_per_s3"),
        fault_acceleration("fault_" + acceleration),
        fault_jerk("fault_" + jerk),
        following_error("following_error_" + unit),
        home("home_" + unit) {}
};

void read_travel(Section& section, const JointKeys& keys, double unit, JointSpec& joint) {
  joint.is_endless = joint.is_rotary && section.truth_or("endless", false);
  if (joint.is_endless) {
    if (section.has(keys.travel)) {
      section.refuse(keys.travel, "either " + keys.travel + " or endless = true",
                     "remove one of the two");
    }
    return;
  }
  // Within 1e5 deg and 1e5 mm a double resolves 2e-11 of the unit.
  const auto [low, high] =
      section.pair(keys.travel, {-1e5, 1e5},
                   joint.is_rotary ? "give [minimum, maximum], or write endless = true" : "");
  if (!(low < high)) section.refuse(keys.travel, "minimum below maximum", "swap the two numbers");
  joint.limits.travel_min = low * unit;
  joint.limits.travel_max = high * unit;
}

/// An axis letter, or any letter with one or two digits; "-" before it or not.
bool is_nc_word(std::string_view word) {
  if (!word.empty() && word[0] == '-') word.remove_prefix(1);
  if (word.empty() || word.size() > 3 || word[0] < 'A' || word[0] > 'Z') return false;
  if (word.size() == 1) return std::string_view("XYZABCUVW").find(word) != std::string_view::npos;
  return std::all_of(word.begin() + 1, word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

void read_limits(Section& section, JointSpec& joint) {
  const JointKeys keys(joint.is_rotary ? "deg" : "mm");
  const double unit = joint.is_rotary ? units::kDegree_rad : 1.0;
  constexpr Range kRate{1e-3, 1e9};
  JointLimits& limits = joint.limits;

  read_travel(section, keys, unit, joint);
  limits.velocity = section.number(keys.velocity, kRate) * unit;
  limits.acceleration = section.number(keys.acceleration, kRate) * unit;
  limits.jerk = section.number(keys.jerk, kRate) * unit;
  limits.fault_acceleration = section.number(keys.fault_acceleration, kRate) * unit;
  limits.fault_jerk = section.number(keys.fault_jerk, kRate) * unit;
  limits.following_error = section.number(keys.following_error, {1e-6, 1e4}) * unit;
  if (limits.fault_acceleration < limits.acceleration) {
    section.refuse(keys.fault_acceleration, "at least " + keys.acceleration,
                   "a FaultStop may not be softer than a stop");
  }
  if (limits.fault_jerk < limits.jerk) {
    section.refuse(keys.fault_jerk, "at least " + keys.jerk,
                   "a FaultStop may not be softer than a stop");
  }
}

void read_nc_word(Section& section, JointSpec& joint) {
  joint.nc_word = section.text_or("nc_word", "");
  if (joint.nc_word.empty() || is_nc_word(joint.nc_word)) return;
  section.refuse("nc_word",
                 "one of X Y Z A B C U V W, or a letter with one or two digits; - before it where "
                 "the controller counts against the joint",
                 "write the address that the controller has for this joint");
}

void read_joint(Section section, JointSpec& joint) {
  const JointKeys keys(joint.is_rotary ? "deg" : "mm");
  const JointLimits& limits = joint.limits;
  read_limits(section, joint);
  joint.home =
      section.number(keys.home, {-1e5, 1e5}) * (joint.is_rotary ? units::kDegree_rad : 1.0);
  read_nc_word(section, joint);
  if (!joint.is_endless && (joint.home < limits.travel_min || joint.home > limits.travel_max)) {
    section.refuse(keys.home, "inside " + keys.travel, "move home into travel");
  }
  section.finish();
}

namespace {

void read_tolerances(Section section, MachineModel& model) {
  model.transition =
      static_cast<Transition>(section.choice_or("transition", 1, {"exact_stop", "smooth"}));
  const bool is_smooth = model.transition == Transition::kSmooth;
  model.tolerances.tip_mm =
      section.number("tip_mm", is_smooth ? kTipTolerance_mm : kRestTipTolerance_mm);
  model.tolerances.axis_rad = units::rad_from_deg(
      section.number("axis_deg", is_smooth ? kAxisTolerance_deg : kRestAxisTolerance_deg));
  section.finish();
}

void read_rewind(Section section, MachineModel& model) {
  model.rewind_policy =
      static_cast<RewindPolicy>(section.choice_or("policy", 0, {"refuse", "retract"}));
  if (model.rewind_policy == RewindPolicy::kRetract) {
    model.rewind_retract_mm = section.number(
        "retract_mm", {1, 1e4}, "say how far the tool leaves the part before C may turn");
  } else if (section.has("retract_mm")) {
    section.refuse("retract_mm", "nothing beside policy = \"refuse\"",
                   "remove it, or write policy = \"retract\"");
  }
  section.finish();
}

void read_frame(Section section, MachineModel& model) {
  const auto origin = section.triple_or("origin_mm", {0, 0, 0}, kLength_mm);
  const auto [a, b, c] = section.triple_or("rotation_deg", {0, 0, 0}, {-360, 360});
  place_workpiece(model, {rotation_from_deg(a, b, c), to_vector(origin)});
  section.finish();
}

}  // namespace

namespace {

MachineModel read_file(const toml::table& table, const std::string& name) {
  Section file(name, table);
  MachineModel model;
  read_machine(file.section("machine"), model);
  Section joints = file.section("joints");
  read_kinematics(file.section("kinematics"), joints, model);
  joints.finish();
  read_stage(file.section_or("stage"), model);
  read_tolerances(file.section("tolerances"), model);
  Section pole = file.section("pole");
  model.pole_policy = static_cast<PolePolicy>(pole.choice("policy", {"ease", "exact"}));
  model.tolerances.pole_axis_rad = units::rad_from_deg(pole.number_or("axis_deg", 0, {0, 10}));
  pole.finish();
  if (file.has("unwind")) {
    file.refuse("unwind", "rewind", "the table is called [rewind] now; rename it");
  }
  read_rewind(file.section_or("rewind"), model);
  read_frame(file.section_or("frame"), model);
  model.keep_out = read_keep_out(file, model);
  model.tip_box = read_tip_box(file, model);
  (void)read_homing(file.section_or("homing"), model.joint_count);
  (void)read_positions(file, model);
  (void)read_meshes(file, model);
  (void)read_monitoring(file.section_or("monitoring"), model);
  file.finish();
  return model;
}

}  // namespace

MachineModel load_machine(const std::filesystem::path& path) {
  return read_file(parse_file(path), path.string());
}

MachineModel parse_machine(std::string_view text, const std::string& name) {
  return read_file(parse_text(text, name), name);
}

}  // namespace meridian::config
