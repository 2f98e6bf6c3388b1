// SPDX-License-Identifier: Apache-2.0
#include "service/panel/scene.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/panel/json_text.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

/// A joint as it moves what it carries: along, or about, `direction` in M with every joint at zero.
struct Screw {
  int joint = 0;
  bool is_rotary = false;
  Vector3 direction = Vector3::UnitZ();
  Vector3 point_mm = Vector3::Zero();
};

/// Every family of machines in one form.
struct Screws {
  std::vector<Screw> head, table;  ///< from the base on
  Vector3 gauge_mm = Vector3::Zero(), axis = Vector3::UnitZ();
};

[[nodiscard]] Screws screws_of(const ChainKinematics& chain) {
  Screws out;
  for (const ChainJoint& one : chain.chain) {
    const Screw screw{one.joint, one.is_rotary, one.direction, one.point_mm};
    if (one.is_table_side) {
      out.table.insert(out.table.begin(), screw);
    } else {
      out.head.push_back(screw);
    }
  }
  out.gauge_mm = chain.gauge_mm;
  out.axis = chain.home_axis;
  return out;
}

/// The table slides and turns against its joints, docs/kinematics.md, chapter 2.
[[nodiscard]] Screws screws_of(const LaiKinematics& lai) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  const Vector3 pivot(0, -lai.e_mm, lai.h_mm);
  Screws out;
  out.table = {{lai::kB2, false, -y}, {lai::kTheta1, true, -z}};
  out.head = {{lai::kB3, false, x}, {lai::kB4, false, -z}, {lai::kTheta2, true, y, pivot}};
  out.gauge_mm = pivot - lai.pivot_mm * z;
  return out;
}

/// The arm stretched along x; the shoulder lifts it, docs/kinematics.md, chapter 5.
[[nodiscard]] Screws screws_of(const RobotKinematics& robot) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  const Vector3 shoulder = robot.shoulder_height_mm * z;
  const Vector3 elbow = shoulder + robot.upper_arm_mm * x;
  const Vector3 wrist = elbow + robot.forearm_mm * x;
  Screws out;
  out.head = {{robot::kYaw, true, z},
              {robot::kShoulder, true, -y, shoulder},
              {robot::kElbow, true, -y, elbow}};
  if (robot.has_spherical_wrist) {
    out.head.push_back({robot::kRoll, true, x, wrist});
    out.head.push_back({robot::kBend, true, -y, wrist});
    out.head.push_back({robot::kSpin, true, x, wrist});
  } else {
    out.head.push_back({robot::kPitch, true, -y, wrist});
    out.head.push_back({robot::kTilt, true, z, wrist});
  }
  out.gauge_mm = wrist + robot.wrist_mm * x;
  out.axis = -x;
  return out;
}

[[nodiscard]] Screws screws_of(const MachineModel& model) {
  switch (model.family) {
    case MachineFamily::kChain:
      return screws_of(model.chain);
    case MachineFamily::kRobot:
      return screws_of(model.robot);
    case MachineFamily::kLai:
      break;
  }
  return screws_of(model.lai);
}

[[nodiscard]] json to_json(const Vector3& v) { return json::array({v[0], v[1], v[2]}); }

[[nodiscard]] json to_json(const std::vector<Screw>& screws) {
  json out = json::array();
  for (const Screw& screw : screws) {
    out.push_back({{"joint", screw.joint},
                   {"rotary", screw.is_rotary},
                   {"direction", to_json(screw.direction)},
                   {"point", to_json(screw.point_mm)}});
  }
  return out;
}

[[nodiscard]] json to_json(const JointSpec& joint) {
  const JointLimits& limits = joint.limits;
  return {{"name", joint.name},          {"rotary", joint.is_rotary},
          {"endless", joint.is_endless}, {"travel", {limits.travel_min, limits.travel_max}},
          {"velocity", limits.velocity}, {"acceleration", limits.acceleration},
          {"jerk", limits.jerk},         {"following", limits.following_error},
          {"home", joint.home}};
}

[[nodiscard]] json stage_to_json(const MachineModel& model) {
  const ActuatorStage& g = model.stage;
  if (g.kind == StageKind::kIdentity) return nullptr;
  return {{"kind", g.kind == StageKind::kPinSlot ? "pin_slot" : "two_slider"},
          {"linear", g.linear_joint},
          {"rotary", g.rotary_joint},
          {"sign_s", g.sign_s},
          {"offset_s", g.offset_s_mm},
          {"sign_phi", g.sign_phi},
          {"offset_phi", g.offset_phi_rad},
          {"radius", g.radius_mm},
          {"rail", g.rail_mm},
          {"rod", g.rod_mm},
          {"sides", {g.side1, g.side2}},
          {"drives", {to_json(model.stage_drives[0]), to_json(model.stage_drives[1])}}};
}

[[nodiscard]] json frame_to_json(const MachineModel& model) {
  json rotation = json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rotation.push_back(model.frame_rotation(row, column));
    }
  }
  return {{"rotation", rotation}, {"origin", to_json(model.frame_origin_mm)}};
}

[[nodiscard]] const char* family_name(MachineFamily family) {
  switch (family) {
    case MachineFamily::kChain:
      return "chain";
    case MachineFamily::kRobot:
      return "robot";
    case MachineFamily::kLai:
      break;
  }
  return "lai";
}

}  // namespace

std::string describe_scene(const MachineModel& model, const ToolTable& tools) {
  const Screws screws = screws_of(model);
  json joints = json::array(), table = json::array();
  for (int i = 0; i < model.joint_count; ++i) {
    joints.push_back(to_json(model.joints[static_cast<std::size_t>(i)]));
  }
  for (const Tool& tool : tools.tools()) {
    table.push_back(
        {{"number", tool.number}, {"length", tool.length_mm}, {"radius", tool.radius_mm}});
  }
  const json scene = {{"name", model.name},
                      {"family", family_name(model.family)},
                      {"joints", joints},
                      {"head", to_json(screws.head)},
                      {"table", to_json(screws.table)},
                      {"gauge", to_json(screws.gauge_mm)},
                      {"axis", to_json(screws.axis)},
                      {"frame", frame_to_json(model)},
                      {"stage", stage_to_json(model)},
                      {"free_joint", free_joint(model)},
                      {"pole", to_json(pole_direction(model))},
                      {"tool_length", model.tool_length_mm},
                      {"tools", table},
                      {"tip_tolerance", model.tolerances.tip_mm},
                      {"max_feed", model.max_feed_mm_per_s * 60},
                      {"max_override", model.most_feed_override},
                      {"cycle_s", static_cast<double>(model.cycle_ns) * 1e-9}};
  return json_text(scene);
}

}  // namespace meridian::panel
