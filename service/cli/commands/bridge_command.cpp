// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <thread>

#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/neighbours/bridge/ros_bridge.hpp"
#include "service/neighbours/ros/urdf.hpp"
#include "service/protocol/operator/served_model.hpp"

namespace meridian::cli::bridge_command {
namespace {

struct BridgeOptions {
  PeerOptions peer;
  MachineOptions machine;
  std::uint32_t ros_domain = 0;
  double rate_hz = 50;
  double duration_s = 0;
  bool is_description_alone = false;
};

/// The machine with its kinematics: of the file after --machine, else of the one that the service
/// reports. Throws config::ConfigError.
[[nodiscard]] MachineModel model_of(const BridgeOptions& options, const dds::MachineInfo& info) {
  if (!options.machine.machine.empty()) return load_machine(options.machine);
  if (!info.machine_file.empty()) return stream::served_model(info);
  throw config::ConfigError({.file = info.name,
                             .value = "its service does not report the machine file, which is long",
                             .remedy = "name the file after --machine"});
}

[[nodiscard]] bridge::BridgeTime time_now() {
  using std::chrono::duration_cast, std::chrono::nanoseconds;
  return {duration_cast<nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          duration_cast<nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count()};
}

int run_ros2(BridgeOptions& options) {
  if (options.is_description_alone) {
    std::fputs(ros::urdf_of(load_machine(options.machine)).c_str(), stdout);
    return kFine;
  }
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  const MachineModel model = model_of(options, *machine);
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  dds::Participant ros({.domain = options.ros_domain, .machine = ""});
  bridge::RosBridge bridge(participant, ros, model, time_now());
  watch_for_stop();
  std::printf(
      "machine %s for ROS 2 in domain %u: rt/joint_states and rt/tf at %g Hz; Ctrl-C ends\n",
      machine->name.c_str(), options.ros_domain, options.rate_hz);
  std::fflush(stdout);
  const auto begin = std::chrono::steady_clock::now();
  const auto period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / options.rate_hz));
  for (auto next = begin; !stop_flag().load(); next += period) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    if (options.duration_s > 0 && passed.count() >= options.duration_s) break;
    bridge.work(time_now());
    std::this_thread::sleep_until(next + period);
  }
  const bridge::RosCounts counts = bridge.counts();
  std::printf("sent %" PRIu64 " joint states, %" PRIu64 " transforms, %" PRIu64
              " descriptions, %" PRIu64 " diagnostics; %" PRIu64 " refused\n",
              counts.joint_states, counts.transforms, counts.descriptions, counts.diagnostics,
              counts.refused);
  return counts.refused == 0 ? kFine : kVerdictNo;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BridgeOptions>();
  CLI::App* const bridge = app.add_subcommand(
      "bridge", "The machine for other systems that watch it; they can change nothing");
  bridge->require_subcommand(1);
  CLI::App* const ros2 = bridge->add_subcommand(
      "ros2",
      "Joint states, frames, robot description and diagnostics on the topics of ROS 2, by DDS "
      "alone: for RViz, PlotJuggler, Foxglove and any node");
  add_peer_options(*ros2, options->peer);
  ros2->add_option("-m,--machine", options->machine.machine,
                   "Machine file (TOML); needed where the service's is too long to be reported");
  ros2->add_option("--ros-domain", options->ros_domain, "DDS domain of ROS 2")
      ->envname("ROS_DOMAIN_ID")
      ->capture_default_str()
      ->check(CLI::Range(0, 230));
  ros2->add_option("--rate", options->rate_hz, "Joint states and frames a second")
      ->capture_default_str()
      ->check(finite_range(0.1, 1000.0));
  ros2->add_option("--duration", options->duration_s, "Ends after so many seconds; 0: never")
      ->capture_default_str()
      ->check(finite_range(0.0, 1e9));
  ros2->add_flag("--description", options->is_description_alone,
                 "Print the URDF of the machine file and end; no service is needed")
      ->needs("--machine");
  ros2->callback([options, &exit_code] { exit_code = run_ros2(*options); });
}

}  // namespace meridian::cli::bridge_command
