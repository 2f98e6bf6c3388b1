// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/kinematics_file.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace meridian::config {
namespace {

constexpr Range kDirection{-1e3, 1e3};

void read_named_joints(const std::vector<std::string>& names, std::size_t first_rotary,
                       Section& joints, MachineModel& model) {
  model.joint_count = static_cast<int>(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    model.joints[i].name = names[i];
    model.joints[i].is_rotary = i >= first_rotary;
    read_joint(joints.section(names[i]), model.joints[i]);
  }
}

void read_lai(Section& table, Section& joints, MachineModel& model) {
  model.family = MachineFamily::kLai;
  model.lai = lai_from_table({.b1 = table.number("b1_mm", kLength_mm),
                              .a2 = table.number("a2_mm", kLength_mm),
                              .a3 = table.number("a3_mm", kLength_mm),
                              .l3 = table.number("l3_mm", kLength_mm),
                              .l4 = table.number("l4_mm", kLength_mm),
                              .b5 = table.number("b5_mm", kLength_mm),
                              .l5 = table.number("l5_mm", {0, 1e5})});
  read_named_joints({"b3", "b2", "b4", "theta1", "theta2"}, 3, joints, model);
}

Vector3 direction(Section& section, std::string_view key, const std::string& remedy) {
  const Vector3 v = to_vector(section.triple(key, kDirection, remedy));
  if (!(v.norm() > 1e-6)) section.refuse(key, "a direction that is not zero", remedy);
  return v.normalized();
}

ChainJoint read_chain_joint(Section& section, int index, JointSpec& spec) {
  ChainJoint joint;
  joint.joint = index;
  joint.is_rotary = section.choice("kind", {"linear", "rotary"}) == 1;
  joint.is_table_side = section.choice("side", {"table", "head"}) == 0;
  joint.direction = direction(section, "direction",
                              "give the direction of positive motion at home, in the machine "
                              "frame; its length does not matter");
  if (joint.is_rotary) {
    joint.point_mm =
        to_vector(section.triple("point_mm", kLength_mm, "give any point on the axis at home"));
  }
  spec.is_rotary = joint.is_rotary;
  return joint;
}

void read_chain(Section& table, Section& joints, MachineModel& model) {
  constexpr std::size_t kCount = ChainKinematics::kChainLength;
  const char* remedy = "name the three linear and two rotary joints, each once";
  model.family = MachineFamily::kChain;
  model.joint_count = kCount;
  const auto chain_names = table.texts("chain", kCount, remedy);
  const auto machine_names =
      table.has("machine_order") ? table.texts("machine_order", kCount, remedy) : chain_names;
  for (std::size_t i = 0; i < kCount; ++i) model.joints[i].name = machine_names[i];

  std::array<ChainJoint, kCount> chain;
  std::array<bool, kCount> is_named{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto found = std::find(machine_names.begin(), machine_names.end(), chain_names[i]);
    const auto index = static_cast<std::size_t>(found - machine_names.begin());
    if (index == kCount || is_named[index]) {
      table.refuse(table.has("machine_order") ? "machine_order" : "chain",
                   "the five names of `chain`, each once", remedy);
    }
    is_named[index] = true;
    Section section = joints.section(chain_names[i]);
    JointSpec& spec = model.joints[index];
    chain[i] = read_chain_joint(section, static_cast<int>(index), spec);
    read_joint(section, spec);
  }
  const Vector3 axis = direction(table, "tool_axis", "give the tool axis at home, tip to spindle");
  const Vector3 gauge = to_vector(
      table.triple("gauge_mm", kLength_mm, "give the middle of the spindle's face at home"));
  const auto described = describe_chain(chain, axis, gauge);
  if (!described) {
    table.refuse("chain", "a machine that can work; " + described.error(),
                 "mend the joints' kinds, directions and order");
  }
  model.chain = *described;
  model.is_measured = table.truth_or("measured", false);
}

void read_robot(Section& table, Section& joints, bool is_six_axis, MachineModel& model) {
  model.family = MachineFamily::kRobot;
  model.robot.has_spherical_wrist = is_six_axis;
  model.robot.shoulder_height_mm = table.number("shoulder_height_mm", kLength_mm);
  model.robot.upper_arm_mm = table.number("upper_arm_mm", kPositive_mm);
  model.robot.forearm_mm = table.number("forearm_mm", kPositive_mm);
  model.robot.wrist_mm = table.number("wrist_mm", {0, 1e5});
  std::vector<std::string> names = {"yaw", "shoulder", "elbow", "pitch", "tilt"};
  if (is_six_axis) names = {"yaw", "shoulder", "elbow", "roll", "bend", "spin"};
  read_named_joints(names, 0, joints, model);
}

}  // namespace

void read_kinematics(Section table, Section& joints, MachineModel& model) {
  switch (table.choice("family", {"lai", "chain", "robot5", "robot6"})) {
    case 0:
      read_lai(table, joints, model);
      break;
    case 1:
      read_chain(table, joints, model);
      break;
    default:
      read_robot(table, joints, table.choice("family", {"lai", "chain", "robot5", "robot6"}) == 3,
                 model);
      break;
  }
  table.finish();
}

}  // namespace meridian::config
