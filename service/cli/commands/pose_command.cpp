// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/cli/options/operator/reported_machine.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/pose_solutions.hpp"
#include "service/machine/inspect/pose_table.hpp"

namespace meridian::cli::pose_command {
namespace {

struct Options {
  MachineOptions machine;
  PeerOptions peer;
  std::vector<double> pose, joints;
  std::string pose_table, joint_table;
  bool is_json = false;
};

constexpr double kMinAxis = 1e-9;  // of the length of a tool axis as it is given

int refuse(const std::string& message) {
  std::cerr << "meridian pose: " << message << "\n";
  return kInputRefused;
}

bool are_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

int show_joints(const MachineModel& model, const std::vector<double>& at_edge, bool is_json) {
  const auto count = static_cast<std::size_t>(model.joint_count);
  if (at_edge.size() != count) {
    return refuse("--joints has " + std::to_string(at_edge.size()) + " values, the machine has " +
                  std::to_string(count) + " joints");
  }
  JointVector q{};
  for (std::size_t i = 0; i < count; ++i) {
    q[i] = model.joints[i].is_rotary ? units::rad_from_deg(at_edge[i]) : at_edge[i];
  }
  std::cout << (is_json ? inspect::joints_json(model, q) : inspect::joints_text(model, q));
  const inspect::PoseSolution here = inspect::solution_of_joints(model, q);
  if (here.is_possible()) return kFine;
  if (here.outside >= 0) {
    std::cerr << "OUTSIDE TRAVEL: " << limited_spec(model, here.outside).name << "\n";
  }
  const std::string boxes = inspect::boxes_text(here, model);
  if (!boxes.empty()) std::cerr << boxes.substr(2) << "\n";
  return kVerdictNo;
}

int show_pose(const MachineModel& model, const std::vector<double>& values, bool is_json) {
  const Vector3 axis(values[3], values[4], values[5]);
  const double length = axis.norm();
  if (!std::isfinite(length) || !(length > kMinAxis)) {
    return refuse("the tool axis i j k is no direction");
  }
  const ToolPose pose{{values[0], values[1], values[2]}, axis / length};
  const auto solutions = inspect::solve_all(model, pose);
  if (is_json) {
    std::cout << inspect::to_json(solutions, model, pose);
  } else if (solutions.empty()) {
    std::cout << "out of reach: " << inspect::why_unreachable(model, pose) << "\n";
  } else {
    std::cout << inspect::to_text(solutions, model);
  }
  const bool is_possible = std::any_of(solutions.begin(), solutions.end(),
                                       [](const auto& one) { return one.is_possible(); });
  return is_possible ? kFine : kVerdictNo;
}

/// Rows of `name`, or standard input, to the other side.
int show_table(const MachineModel& model, const Options& options) {
  const bool are_poses = !options.pose_table.empty();
  const std::string& name = are_poses ? options.pose_table : options.joint_table;
  std::ifstream file;
  if (name != "-") file.open(name);
  if (!file) return refuse(name + " cannot be opened");
  const auto columns = are_poses ? inspect::pose_columns() : inspect::joint_columns(model);
  const auto rows = inspect::read_table(name == "-" ? std::cin : file, name, columns);
  if (!rows) {
    std::cerr << rows.error();
    return kInputRefused;
  }
  if (are_poses) {
    for (const inspect::TableRow& row : *rows) {
      if (Vector3(row.values[3], row.values[4], row.values[5]).norm() > kMinAxis) continue;
      return refuse(name + ":" + std::to_string(row.line) +
                    ": the tool axis i j k is no direction");
    }
  }
  const auto result = are_poses ? (options.is_json ? inspect::solve_table_json(model, *rows)
                                                   : inspect::solve_table(model, *rows))
                                : (options.is_json ? inspect::pose_table_json(model, *rows)
                                                   : inspect::pose_table(model, *rows));
  std::cout << result.text;
  if (result.unreached == 0) return kFine;
  std::cerr << "OUTSIDE TRAVEL OR REACH: " << result.unreached << " of " << rows->size()
            << " rows\n";
  return kVerdictNo;
}

/// The machine of the file, or the one that answers, as it is set up now; nothing and an exit code
/// where there is none.
std::optional<MachineModel> find_model(Options& options, int& exit_code) {
  if (!options.machine.machine.empty()) return load_machine(options.machine);
  const auto info = find_machine(options.peer, exit_code);
  if (!info) return std::nullopt;
  auto model = reported_machine(*info);
  if (!model) {
    exit_code =
        refuse("machine " + info->name + " does not publish its file; name it by --machine");
  } else if (!options.machine.frame.empty()) {
    config::place_workpiece(*model, config::parse_frame(options.machine.frame));
  }
  return model;
}

int run(Options& options) {
  const int given = (options.pose.empty() ? 0 : 1) + (options.joints.empty() ? 0 : 1) +
                    (options.pose_table.empty() ? 0 : 1) + (options.joint_table.empty() ? 0 : 1);
  if (given != 1) {
    std::cerr << "meridian pose: give a pose x y z i j k, --joints, --pose-table or "
                 "--joint-table\n";
    return kUsage;
  }
  if (!are_finite(options.pose) || !are_finite(options.joints)) {
    return refuse("every value must be a finite number");
  }
  int exit_code = kFine;
  const auto model = find_model(options, exit_code);
  if (!model) return exit_code;
  if (options.pose.empty() && options.joints.empty()) return show_table(*model, options);
  return options.joints.empty() ? show_pose(*model, options.pose, options.is_json)
                                : show_joints(*model, options.joints, options.is_json);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "pose",
      "A pose of the tool to joints, every branch with its windings, drives and distance from "
      "singularity; or joints to the pose. Exit code 1 where nothing inside travel reaches it");
  command
      ->add_option("pose", options->pose,
                   "Tip x y z in mm and tool axis i j k, in the workpiece; behind -- where a "
                   "number is negative")
      ->expected(6);
  command
      ->add_option("--joints", options->joints,
                   "Joints in machine order, separated by commas, mm and deg")
      ->delimiter(',')
      ->expected(1, kMaxJoints);
  command->add_option("--pose-table", options->pose_table,
                      "Table of poses x y z i j k, one a row, to joints; - is standard input");
  command->add_option("--joint-table", options->joint_table,
                      "Table of joints in machine order, or under their names, to poses");
  command->add_flag("--json", options->is_json, "As JSON");
  command->add_option("-m,--machine", options->machine.machine,
                      "Machine file (TOML); default: the machine that answers, with the work frame "
                      "that is in force there");
  command->add_option("--frame", options->machine.frame,
                      "Where the workpiece lies: x,y,z[,a,b,c] in mm and deg, Rz(c) Ry(b) Rx(a); "
                      "instead of the machine's frame");
  add_peer_options(*command, options->peer);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::pose_command
