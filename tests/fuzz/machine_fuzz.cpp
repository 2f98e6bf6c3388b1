// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "fuzz/fuzz_targets.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::fuzz {
namespace {

/// What everybody behind the reader takes for granted.
void check_machine(const MachineModel& model) {
  require(!model.name.empty(), "a machine without a name");
  require(model.joint_count == 5 || model.joint_count == 6, "joints that no machine has");
  require(model.cycle_ns > 0, "no cycle time");
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[static_cast<std::size_t>(i)];
    const JointLimits& limits = joint.limits;
    for (const double limit : {limits.velocity, limits.acceleration, limits.jerk,
                               limits.fault_acceleration, limits.fault_jerk}) {
      require(std::isfinite(limit) && limit > 0, "a limit that is none");
    }
    require(std::isfinite(joint.home), "a home that is no number");
    require(limits.travel_min < limits.travel_max || joint.is_endless, "no travel");
  }
}

/// At home the tool is somewhere, and its axis is one.
void check_home(const MachineModel& model) {
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    home[n] = model.joints[n].home;
  }
  const ToolPose pose = forward(model, model.tool_length_mm, home);
  require(pose.tip.allFinite(), "no tip at home");
  require(std::abs(pose.axis.norm() - 1) < 1e-9, "no tool axis at home");
  static_cast<void>(solve(model, model.tool_length_mm, pose, 0, home));
}

}  // namespace

void read_machine(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    const MachineModel model = config::parse_machine(text, "fuzz");
    check_machine(model);
    check_home(model);
  } catch (const config::ConfigError& error) {
    require(*error.what() != '\0', "a refusal without words");
  }
}

Seeds machine_seeds(const std::string& folder) {
  std::set<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") paths.insert(entry.path());
  }
  Seeds seeds;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

}  // namespace meridian::fuzz
