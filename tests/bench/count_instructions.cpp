// SPDX-License-Identifier: Apache-2.0

/// count_instructions WORKLOAD N: runs a workload N times. The instruction gates count two such
/// runs under callgrind and take the difference, so that start-up does not count; of a gate of the
/// most of one call, callgrind counts every call for itself.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "bench/cycle_workload.hpp"
#include "bench/ik_workload.hpp"
#include "bench/monitoring_workload.hpp"
#include "bench/planner_workload.hpp"
#include "bench/setpoint_workload.hpp"
#include "bench/smooth_workload.hpp"
#include "bench/trace_workload.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: count_instructions WORKLOAD N\n");
    return 2;
  }
  const std::string_view workload = argv[1];
  const int count = std::atoi(argv[2]);
  std::uint64_t checksum = 0;
  if (workload == "inverse_kinematics") {
    checksum = meridian::bench::run_inverse_kinematics(count);
  } else if (workload == "inverse_kinematics_chain") {
    checksum = meridian::bench::run_chain(count);
  } else if (workload == "inverse_kinematics_robot_5r") {
    checksum = meridian::bench::run_robot_5r(count);
  } else if (workload == "inverse_kinematics_robot_6r") {
    checksum = meridian::bench::run_robot_6r(count);
  } else if (workload == "cycle") {
    checksum = meridian::bench::run_cycle(count);
  } else if (workload == "cycle_single_block") {
    checksum = meridian::bench::run_stepped_cycle(count);
  } else if (workload == "cycle_over_windows") {
    checksum = meridian::bench::run_windowed_cycle(count);
  } else if (workload == "setpoint_spline") {
    checksum = meridian::bench::run_setpoints(meridian::bench::SetpointsOf::kSpline, count);
  } else if (workload == "setpoint_pole") {
    checksum = meridian::bench::run_setpoints(meridian::bench::SetpointsOf::kPole, count);
  } else if (workload == "trace_off") {
    checksum = meridian::bench::run_trace_off(count);
  } else if (workload == "monitoring") {
    checksum = meridian::bench::run_monitoring(count, false);
  } else if (workload == "monitoring_all") {
    checksum = meridian::bench::run_monitoring(count, true);
  } else if (workload == "planner") {
    checksum = meridian::bench::run_planner(count);
  } else if (workload == "smooth_block") {
    checksum = meridian::bench::run_smooth_blocks(count, 0.3);
  } else if (workload == "smooth_dense_block") {
    checksum = meridian::bench::run_smooth_blocks(count, 0.002);
  } else if (workload == "smooth_window") {
    checksum = meridian::bench::run_smooth_hostile(count);
  } else {
    std::fprintf(stderr, "no workload %s\n", argv[1]);
    return 2;
  }
  std::printf("%016llx\n", static_cast<unsigned long long>(checksum));
  return checksum != 0 ? 0 : 1;
}
