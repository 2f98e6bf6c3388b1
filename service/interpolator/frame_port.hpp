// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/work_frame.hpp"
#include "meridian/rt/latest_value.hpp"
#include "meridian/rt/spsc_ring.hpp"
#include "service/interpolator/program_claim.hpp"

namespace meridian::interpolator {

/// The work frame that is in force, for who moves by it: all but the table, which no other thread
/// needs.
struct FrameInForce {
  std::uint32_t change =
      0;  ///< counts what was put in force; 0: the machine file's, from the start
  std::uint8_t number = 0;
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row
  Array3 origin_mm{};
  std::uint64_t sum = 0;  ///< stream::frame_sum()
};
static_assert(std::is_trivially_copyable_v<FrameInForce>);

/// Puts the workpiece of `model` where `frame` says. RT: cycle.
inline void place(MachineModel& model, const FrameInForce& frame) noexcept {
  for (int i = 0; i < 9; ++i) {
    model.frame_rotation(i / 3, i % 3) = frame.rotation[static_cast<std::size_t>(i)];
  }
  model.frame_origin_mm = to_vector(frame.origin_mm);
}

/// What a command of verb `frame` says beside its Arrival.
struct FrameArrival {
  std::uint64_t key = 0;  ///< of the Arrival
  FrameOrder order{};
};

/// The ways of a work frame. The commands thread stores it for the cycle, then tells that; when the
/// cycle has taken it, for the others, and waits until the status says so. Everybody has a machine
/// model of its own, and puts the frame there itself, between two programs.
struct FramePorts {
  SpscRing<FrameArrival, 16> orders;    ///< receive thread to commands
  LatestValue<FrameInForce> for_cycle;  ///< the cycle looks where it accepts the verb
  LatestValue<FrameInForce> for_planner, for_intake, for_telemetry;
  ProgramClaim claim;
  std::atomic<std::uint64_t> status{0};  ///< the first status that told of the newest frame
  std::atomic<std::uint32_t> told{0};    ///< its change; stored behind `status`
};

}  // namespace meridian::interpolator
