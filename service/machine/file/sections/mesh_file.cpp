// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/mesh_file.hpp"

#include <algorithm>

namespace meridian::config {
namespace {

/// Somebody else chose the name: it leads to no other folder.
[[nodiscard]] bool is_plain_stl(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return name.size() > 4 && name.front() != '.' && name.ends_with(".stl") &&
         std::all_of(name.begin(), name.end(), is_plain);
}

[[nodiscard]] bool is_link(const std::string& name, const MachineModel& model) {
  if (name == "base" || name == "part") return true;
  const auto end = model.joints.begin() + model.joint_count;
  return std::any_of(model.joints.begin(), end,
                     [&name](const JointSpec& joint) { return joint.name == name; });
}

}  // namespace

std::vector<Mesh> read_meshes(Section& file, const MachineModel& model) {
  std::vector<Mesh> meshes;
  for (Section& section : file.sections_or("mesh")) {
    Mesh mesh{section.text("link", "name what the body moves with"),
              section.text("file", "name the STL file")};
    if (!is_link(mesh.link, model)) {
      section.refuse("link", "\"base\", \"part\" or the name of a joint",
                     "name the joint that moves it last, seen from the base");
    }
    if (!is_plain_stl(mesh.file)) {
      section.refuse("file", "letters, digits, _ - and ., and .stl at the end, without a folder",
                     "rename the file; the folder is an option of meridian panel");
    }
    section.finish();
    meshes.push_back(std::move(mesh));
    if (meshes.size() > kMaxMeshes) {
      section.refuse("file", "at most " + std::to_string(kMaxMeshes) + " meshes",
                     "put two of them into one");
    }
  }
  return meshes;
}

std::vector<Mesh> parse_meshes(std::string_view text, const std::string& name,
                               const MachineModel& model) {
  const toml::table table = parse_text(text, name);
  Section file(name, table);
  return read_meshes(file, model);
}

}  // namespace meridian::config
