// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/positions_file.hpp"

#include <algorithm>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::config {
namespace {

constexpr const char* kHome = "home";

[[nodiscard]] JointVector read_joints(Section& position, const MachineModel& model) {
  const auto count = static_cast<std::size_t>(model.joint_count);
  const auto values = position.numbers("joints", count, count, {-1e5, 1e5},
                                       "give every joint, in machine order, mm and deg");
  JointVector joints{};
  for (std::size_t i = 0; i < count; ++i) {
    joints[i] = model.joints[i].is_rotary ? units::rad_from_deg(values[i]) : values[i];
  }
  const int outside = first_joint_outside_travel(model, joints, 0);
  if (outside >= 0) {
    position.refuse("joints", "inside the travel of " + limited_spec(model, outside).name,
                    "move the position into travel");
  }
  const int box = keep_out_at(model.keep_out, joints);
  if (box >= 0) {
    position.refuse("joints",
                    std::string("outside of the keep-out box ") + model.keep_out.name_of(box),
                    "move the position out of the box");
  }
  if (tip_axis_outside(model, model.tool_length_mm, joints) >= 0) {
    position.refuse("joints", "joints that have the tip in the tip box", "move the position");
  }
  return joints;
}

}  // namespace

std::vector<NamedPosition> read_positions(Section& file, const MachineModel& model) {
  std::vector<NamedPosition> positions;
  for (Section& section : file.sections_or("position")) {
    NamedPosition position;
    position.name = section.text("name", "say what operators call the position");
    const bool is_taken =
        position.name == kHome ||
        std::any_of(positions.begin(), positions.end(), [&position](const NamedPosition& other) {
          return other.name == position.name;
        });
    if (is_taken) section.refuse("name", "a name of its own", "home is that of the joints");
    position.joints = read_joints(section, model);
    section.finish();
    positions.push_back(position);
  }
  return positions;
}

namespace {

/// Those of a table, home first.
[[nodiscard]] std::vector<NamedPosition> positions_of(const toml::table& table,
                                                      const std::string& name,
                                                      const MachineModel& model) {
  Section file(name, table);
  std::vector<NamedPosition> positions = read_positions(file, model);
  NamedPosition home{kHome, {}};
  for (int i = 0; i < model.joint_count; ++i) home.joints[i] = model.joints[i].home;
  positions.insert(positions.begin(), home);
  return positions;
}

[[nodiscard]] PositionsByName by_name(const std::vector<NamedPosition>& positions,
                                      const MachineModel& model) {
  PositionsByName out;
  for (const NamedPosition& position : positions) {
    const auto* const first = position.joints.data();
    out[position.name] = {first, first + model.joint_count};
  }
  return out;
}

}  // namespace

std::vector<NamedPosition> parse_positions(std::string_view text, const std::string& name) {
  return positions_of(parse_text(text, name), name, parse_machine(text, name));
}

PositionsByName positions_by_name(std::string_view text, const std::string& name) {
  const MachineModel model = parse_machine(text, name);
  return by_name(positions_of(parse_text(text, name), name, model), model);
}

PositionsByName load_positions(const std::filesystem::path& path) {
  const MachineModel model = load_machine(path);
  return by_name(positions_of(parse_file(path), path.string(), model), model);
}

}  // namespace meridian::config
