// SPDX-License-Identifier: Apache-2.0
// scene_cases FOLDER: for every machine file of FOLDER one line of JSON with its scene and a
// hundred poses inside travel, whose tip and axis are those of forward(). Read by scene_test.js.
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/panel/scene.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

[[nodiscard]] JointVector draw_joints(const MachineModel& model, std::mt19937_64& engine) {
  JointVector q{};
  for (int i = 0; i < model.joint_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const JointSpec& joint = model.joints[at];
    const double low = joint.is_endless ? -20 : joint.limits.travel_min;
    const double high = joint.is_endless ? 20 : joint.limits.travel_max;
    q[at] = std::uniform_real_distribution<double>(low, high)(engine);
  }
  return q;
}

[[nodiscard]] json case_of(const MachineModel& model) {
  std::mt19937_64 engine(20260101);
  json poses = json::array();
  for (int i = 0; i < 100; ++i) {
    const JointVector q = draw_joints(model, engine);
    const double tool_length = std::uniform_real_distribution<double>(20, 200)(engine);
    const Pose<double> pose = forward(model, tool_length, q);
    json joints = json::array();
    for (int k = 0; k < model.joint_count; ++k) joints.push_back(q[static_cast<std::size_t>(k)]);
    poses.push_back(
        {{"joints", joints}, {"tool", tool_length}, {"tip", pose.tip}, {"axis", pose.axis}});
  }
  return {{"scene", json::parse(describe_scene(model, {}))}, {"poses", poses}};
}

}  // namespace
}  // namespace meridian::panel

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  for (const auto& file : files) {
    const auto model = meridian::config::load_machine(file);
    std::printf("%s\n", meridian::panel::case_of(model).dump().c_str());
  }
}
