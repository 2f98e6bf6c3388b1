// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/move_options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/analysis/simulate/move_forecast.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/operator/print_end.hpp"
#include "service/cli/options/operator/reported_machine.hpp"
#include "service/machine/file/sections/positions_file.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/protocol/limits_sum.hpp"
#include "service/protocol/operator/move_run.hpp"
#include "service/text/number.hpp"

namespace meridian::cli {
namespace {

void print_joints(const MachineModel& model, const JointVector& joints) {
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[i];
    std::printf("    %s %.4f %s\n", joint.name.c_str(),
                joint.is_rotary ? units::deg_from_rad(joints[i]) : joints[i],
                joint.is_rotary ? "deg" : "mm");
  }
}

[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> words{""};
  for (const char letter : text) {
    if (letter == ',') {
      words.emplace_back();
    } else {
      words.back() += letter;
    }
  }
  return words;
}

/// The joints of the position called `name`.
[[nodiscard]] Expected<JointVector, std::string> position_of(const std::string& name,
                                                             const dds::MachineInfo& machine) {
  std::string names;
  for (const config::NamedPosition& position :
       config::parse_positions(machine.machine_file, "machine file of the service")) {
    if (position.name == name) return position.joints;
    names += " " + position.name;
  }
  return tl::make_unexpected("machine " + machine.name + " has no position " + name +
                             "; there are" + names);
}

/// What the options ask for of a machine that stands at `now`, or what is wrong with them.
[[nodiscard]] Expected<stream::StraightMove, std::string> move_of(const MoveOptions& options,
                                                                  const dds::MachineInfo& machine,
                                                                  const MachineModel& model,
                                                                  const JointVector& now) {
  const ToolPose from = forward(model, model.tool_length_mm, now);
  if (!options.tip.empty()) {
    const auto to = pose_of(options.tip, from);
    if (to) return stream::StraightMove{from, *to, *options.feed, {}};
    return tl::make_unexpected("--tip '" + options.tip + "': say x,y,z or x,y,z,i,j,k");
  }
  const auto joints = options.joints.empty() ? position_of(options.position, machine)
                                             : joints_of(options.joints, model, now);
  if (!joints) return tl::make_unexpected(joints.error());
  const ToolPose end = forward(model, model.tool_length_mm, *joints);
  return stream::StraightMove{end, end, *options.feed, *joints};
}

[[nodiscard]] int exit_code_of(const stream::MoveResult& result) {
  switch (result.end) {
    case stream::MoveEnd::kThere:
      return kFine;
    case stream::MoveEnd::kRefused:
      return print_refusal(result.text);
    case stream::MoveEnd::kStopped:
      return print_failure("the move was stopped on its way: " + result.text, kVerdictNo);
    case stream::MoveEnd::kNoAnswer:
      return print_silence();
  }
  return kVerdictNo;
}

}  // namespace

std::vector<const CLI::Option*> add_move_options(CLI::App& command, MoveOptions& options) {
  return {command.add_option("--tip", options.tip,
                             "move: where the tip goes straight: x,y,z[,i,j,k] in the work frame "
                             "in force, mm; without i,j,k the tool axis stays"),
          command.add_option("--joints", options.joints,
                             "move: where joints go straight, all at once: NAME=VALUE with commas "
                             "between, mm and deg; the others stay"),
          command.add_option("--to", options.position,
                             "move: the position of the machine file where the joints go, or home"),
          command
              .add_option(
                  "--feed", options.feed,
                  "move, probe: feed of the tip, mm/min; of joints along their way, 1 rad as 50 "
                  "mm")
              ->check(finite_range(1e-3, 1e6))};
}

void print_pose(const char* what, const ToolPose& pose) {
  std::printf("%s %.4f %.4f %.4f mm, axis %.6f %.6f %.6f\n", what, pose.tip.x(), pose.tip.y(),
              pose.tip.z(), pose.axis.x(), pose.axis.y(), pose.axis.z());
}

std::optional<ToolPose> pose_of(const std::string& text, const ToolPose& now) {
  std::array<double, 6> value{0, 0, 0, now.axis.x(), now.axis.y(), now.axis.z()};
  const std::vector<std::string> words = split_at_commas(text);
  if (words.size() != 3 && words.size() != value.size()) return std::nullopt;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!text::read_finite(words[i], value[i])) return std::nullopt;
  }
  return ToolPose{{value[0], value[1], value[2]}, {value[3], value[4], value[5]}};
}

Expected<JointVector, std::string> joints_of(const std::string& text, const MachineModel& model,
                                             const JointVector& now) {
  JointVector joints = now;
  for (const std::string& word : split_at_commas(text)) {
    const std::size_t sign = word.find('=');
    const std::string name = word.substr(0, sign);
    const auto begin = model.joints.begin(), end = begin + model.joint_count;
    const auto joint =
        std::find_if(begin, end, [&name](const JointSpec& known) { return known.name == name; });
    double value = 0;
    const std::string number = sign == std::string::npos ? "" : word.substr(sign + 1);
    if (joint == end || !text::read_finite(number, value)) {
      return tl::make_unexpected("'" + word + "': say a joint of machine " + model.name +
                                 " and its value, as " + begin->name + "=12.5");
    }
    joints[static_cast<std::size_t>(joint - begin)] =
        joint->is_rotary ? units::rad_from_deg(value) : value;
  }
  return joints;
}

int run_move(const MoveOptions& options, const dds::MachineInfo& machine,
             dds::Participant& participant, stream::OperatorLink& link,
             const std::string& operator_name, const PeerOptions& peer) {
  const int targets = !options.tip.empty() + !options.joints.empty() + !options.position.empty();
  if (targets != 1 || !options.feed) {
    return print_failure("move needs one of --tip, --joints and --to, and --feed", kUsage);
  }
  auto model = reported_machine(machine);
  if (!model) return print_failure("the machine does not publish its file", kVerdictNo);
  if (!link.wait_for_status(peer.timeout())) {
    return print_failure("machine " + machine.name + " does not answer", kNoPeer);
  }
  const dds::Status status = *link.status();
  if (status.state != State::kReady || status.session != 0) {
    return print_refusal("the machine is " + std::string(name_of(status.state)) +
                         "; a move begins in Ready, with no program");
  }
  model->tool_length_mm = status.tool_length_mm;
  const auto move = move_of(options, machine, *model, status.joints);
  if (!move) return print_failure(move.error(), kUsage);
  const simulate::MoveForecast forecast = simulate::forecast(*move, status.joints, *model);
  if (!forecast.refusal.empty()) return print_refusal(forecast.refusal);
  print_pose("from", forward(*model, status.tool_length_mm, status.joints));
  print_pose("to  ", move->to);
  if (move->joints) print_joints(*model, *move->joints);
  std::printf("%.2f s at 100 %%\n", forecast.time_s);
  std::fflush(stdout);
  watch_for_stop();
  const stream::MoveOrder order{*move,
                                status.joints,
                                status.tool_length_mm,
                                operator_name,
                                stream::frame_sum(*model, machine.work_frames),
                                status.tools,
                                stream::limits_sum(machine.soft_limits)};
  const auto result = stream::run_move(participant, link, order, stop_flag(), peer.timeout());
  const int exit_code = exit_code_of(result);
  if (exit_code == kFine) std::printf("there\n");
  return exit_code;
}

}  // namespace meridian::cli
