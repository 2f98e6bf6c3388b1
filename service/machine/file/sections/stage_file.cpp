// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/stage_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/machine/file/sections/kinematics_file.hpp"

namespace meridian::config {
namespace {

constexpr double kRodMargin = 1.05;   // over the farthest that a pin gets from its rail
constexpr double kMinShare = 0.05;    // of the determinant at φ = 0
constexpr double kSameJoints = 1e-9;  // there and back rounds by 1e-12
constexpr int kSteps = 2000;          // of the stage's turn, looked at one by one

enum Kind { kIdentity, kTrailing, kScissor, kPinSlot };

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// The joint that `key` names, linear or rotary as asked for. Programs call its drives instead.
int find_joint(Section& table, const char* key, bool is_rotary, const MachineModel& model) {
  const std::string kind = is_rotary ? "rotary" : "linear";
  const std::string remedy = "name the " + kind + " joint that the stage carries";
  const std::string name = table.text(key, remedy);
  std::string allowed = "a " + kind + " joint of the machine:";
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[static_cast<std::size_t>(i)];
    if (joint.is_rotary != is_rotary) continue;
    if (joint.name == name && !joint.nc_word.empty()) {
      table.refuse(
          key, "a joint without nc_word",
          "programs call the two drives: move nc_word from joints." + name + " into their tables");
    }
    if (joint.name == name) return i;
    allowed += " " + joint.name;
  }
  table.refuse(key, allowed, remedy);
}

double read_sign(Section& table, const char* key) {
  const int sign = table.integer_or(key, 1, -1, 1);
  if (sign == 0) table.refuse(key, "1 or -1", "1 where both grow together, -1 where not");
  return sign;
}

void read_geometry(Section& table, int kind, ActuatorStage& stage) {
  stage.rail_mm = table.number("rail_mm", kind == kPinSlot ? kPositive_mm : Range{0, 1e5},
                               "give the distance from the table's centre line to a slider's rail");
  if (kind == kPinSlot) return;
  stage.radius_mm = table.number("radius_mm", kPositive_mm);
  stage.rod_mm = table.number("rod_mm", kPositive_mm);
  stage.side1 = table.choice_or("rods", 0, {"ahead", "behind"}) == 0 ? 1 : -1;
  stage.side2 = kind == kTrailing ? stage.side1 : -stage.side1;
}

/// No rod comes near standing square to its rail.
void check_rods(Section& table, const ActuatorStage& stage) {
  const double cosine = std::cos(stage.phi_max_rad);
  const double farthest = std::max(std::abs(stage.radius_mm - stage.rail_mm),
                                   std::abs(stage.radius_mm * cosine - stage.rail_mm));
  if (stage.rod_mm > kRodMargin * farthest) return;
  table.refuse("rod_mm", "above " + number(kRodMargin * farthest) + " mm",
               "a shorter rod would come to stand square to its rail, where its slider runs away");
}

/// Whether the stage is far from a dead point at the turn `phi`, and its drives give it back.
bool is_regular(const ActuatorStage& stage, double phi) {
  JointVector q{};
  q[static_cast<std::size_t>(stage.rotary_joint)] = stage.sign_phi * (phi - stage.offset_phi_rad);
  JointVector middle{};
  middle[static_cast<std::size_t>(stage.rotary_joint)] = -stage.sign_phi * stage.offset_phi_rad;
  const double share = stage::determinant(stage, q) / stage::determinant(stage, middle);
  const JointVector back = stage::joints_of(stage, stage::drives_of(stage, q));
  double apart = 0;
  for (std::size_t i = 0; i < q.size(); ++i) apart = std::max(apart, std::abs(back[i] - q[i]));
  return share >= kMinShare && apart <= kSameJoints;
}

void check_turn(Section& table, const ActuatorStage& stage) {
  for (int n = 0; n <= kSteps; ++n) {
    const double phi = stage.phi_max_rad * n / kSteps;
    if (is_regular(stage, phi) && is_regular(stage, -phi)) continue;
    table.refuse("turn_max_deg", "below " + number(units::deg_from_rad(phi)) + " deg",
                 "the stage comes near a dead point there: let it turn less, or change its "
                 "lengths");
  }
}

/// The travel of the rotary joint lies inside what the stage turns.
void check_travel(Section& table, const MachineModel& model) {
  const ActuatorStage& stage = model.stage;
  const JointSpec& joint = model.joints[static_cast<std::size_t>(stage.rotary_joint)];
  const auto phi = [&stage](double q) {
    return std::abs(stage.sign_phi * q + stage.offset_phi_rad);
  };
  if (joint.is_endless) {
    table.refuse(
        "rotary", "a joint with travel",
        "no stage turns without end: give " + joint.name + " travel_deg inside turn_max_deg");
  }
  const double max = std::max(phi(joint.limits.travel_min), phi(joint.limits.travel_max));
  if (max > stage.phi_max_rad * (1 + 1e-12)) {
    table.refuse(
        "turn_max_deg",
        "at least " + number(units::deg_from_rad(max)) + " deg, the travel of " + joint.name,
        "shorten joints." + joint.name + ".travel_deg, or let the stage turn farther");
  }
}

void read_drives(Section& table, MachineModel& model) {
  const char* remedy = "name the two sliders, the one on the side of the first pin first";
  const auto names = table.texts("drives", kStageDrives, remedy);
  JointVector home{};
  for (std::size_t i = 0; i < home.size(); ++i) home[i] = model.joints[i].home;
  const LimitedVector at_home = limited_of(model, home);
  for (std::size_t k = 0; k < kStageDrives; ++k) {
    JointSpec& drive = model.stage_drives[k];
    drive.name = names[k];
    bool is_taken = k == 1 && names[0] == names[1];
    for (const JointSpec& joint : model.joints) is_taken = is_taken || joint.name == names[k];
    if (is_taken) table.refuse("drives", "two names that nothing else has", remedy);
    Section section = table.section(names[k]);
    read_limits(section, drive);
    read_nc_word(section, drive);
    drive.home = at_home[static_cast<std::size_t>(model.joint_count) + k];
    if (drive.home < drive.limits.travel_min || drive.home > drive.limits.travel_max) {
      section.refuse("travel_mm", "travel that holds " + number(drive.home) + " mm",
                     "the drive stands there where the joints are at home");
    }
    section.finish();
  }
}

}  // namespace

void read_stage(Section table, MachineModel& model) {
  const int kind =
      table.choice_or("kind", kIdentity, {"identity", "trailing", "scissor", "pin-slot"});
  if (kind == kIdentity) return table.finish();
  ActuatorStage& stage = model.stage;
  stage.kind = kind == kPinSlot ? StageKind::kPinSlot : StageKind::kTwoSlider;
  stage.linear_joint = find_joint(table, "linear", false, model);
  stage.rotary_joint = find_joint(table, "rotary", true, model);
  stage.sign_s = read_sign(table, "slide_sign");
  stage.sign_phi = read_sign(table, "turn_sign");
  stage.offset_s_mm = table.number_or("slide_offset_mm", 0, kLength_mm);
  stage.offset_phi_rad = units::rad_from_deg(table.number_or("turn_offset_deg", 0, {-360, 360}));
  read_geometry(table, kind, stage);
  stage.phi_max_rad = units::rad_from_deg(
      table.number("turn_max_deg", {0.1, 89}, "say how far the stage turns either way"));
  if (kind != kPinSlot) check_rods(table, stage);
  check_turn(table, stage);
  check_travel(table, model);
  read_drives(table, model);
  table.finish();
}

}  // namespace meridian::config
