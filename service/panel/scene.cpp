// SPDX-License-Identifier: Apache-2.0
#include "service/panel/scene.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/scene/link_tree.hpp"
#include "service/panel/json_text.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

[[nodiscard]] json to_json(const Vector3& v) { return json::array({v[0], v[1], v[2]}); }

[[nodiscard]] json to_json(const std::vector<scene::Screw>& screws) {
  json out = json::array();
  for (const scene::Screw& screw : screws) {
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
      rotation.push_back(model.X_MW.rotation(row, column));
    }
  }
  return {{"rotation", rotation}, {"origin", to_json(model.X_MW.origin_mm)}};
}

/// The tip box in force; null where there is none.
[[nodiscard]] json tip_box_to_json(const TipBox& box) {
  if (!box.is_set) return nullptr;
  return {{"min", box.min}, {"max", box.max}};
}

/// The keep-out boxes in force, each with the joints that it names.
[[nodiscard]] json keep_out_to_json(const KeepOut& keep_out) {
  json out = json::array();
  for (const KeepOutBox& box : keep_out.boxes()) {
    json joints = json::array();
    for (std::size_t i = 0; i < box.min.size(); ++i) {
      if (!box.has(static_cast<int>(i))) continue;
      joints.push_back({{"joint", i}, {"min", box.min[i]}, {"max", box.max[i]}});
    }
    out.push_back({{"name", box.name.data()}, {"joints", joints}});
  }
  return out;
}

[[nodiscard]] json to_json(const std::vector<config::Mesh>& meshes) {
  json out = json::array();
  for (const config::Mesh& mesh : meshes) out.push_back({{"link", mesh.link}});
  return out;
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

std::string describe_scene(const MachineModel& model, const ToolTable& tools,
                           const SoftLimits& soft_limits, const std::vector<config::Mesh>& meshes) {
  const scene::LinkTree tree = scene::link_tree(model);
  const SoftLimits in_force = travel_under(soft_limits, model);
  json joints = json::array(), table = json::array();
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    const SoftLimits::Row& row = soft_limits.rows()[i];
    joints.push_back(to_json(model.joints[i]));
    if (row.is_set) joints.back()["soft_limits"] = {row.min, row.max};
  }
  for (const Tool& tool : tools.tools()) {
    table.push_back({{"number", tool.number},
                     {"length", tool.tip_length_mm()},
                     {"radius", tool.cutting_radius_mm()}});
  }
  const json picture = {{"name", model.name},
                        {"family", family_name(model.family)},
                        {"joints", joints},
                        {"head", to_json(tree.head)},
                        {"table", to_json(tree.table)},
                        {"gauge", to_json(tree.gauge_mm)},
                        {"axis", to_json(tree.axis)},
                        {"frame", frame_to_json(model)},
                        {"stage", stage_to_json(model)},
                        {"tip_box", tip_box_to_json(in_force.tip_box())},
                        {"keep_out", keep_out_to_json(in_force.keep_out())},
                        {"redundant_joint", redundant_joint(model)},
                        {"pole", to_json(pole_direction(model))},
                        {"tool_length", model.tool_length_mm},
                        {"tools", table},
                        {"meshes", to_json(meshes)},
                        {"tip_tolerance", model.tolerances.tip_mm},
                        {"max_feed", model.max_feed_mm_per_s * 60},
                        {"max_override", model.max_feed_override},
                        {"cycle_s", static_cast<double>(model.cycle_ns) * 1e-9}};
  return json_text(picture);
}

}  // namespace meridian::panel
