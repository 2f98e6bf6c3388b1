// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "meridian/cycle/latest_value.hpp"
#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/soft_limits.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/kinematics/work_frame.hpp"
#include "service/daemon/ports/mailbox.hpp"
#include "service/daemon/ports/program_claim.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::interpolator {

/// The set-up that is in force, for who moves by it: the work frame, the soft limits, and by which
/// sum the tool table is known; the tools themselves pass through mailboxes.
struct SetUpInForce {
  std::uint32_t change = 0;  ///< counts what was put in force; 0: what the service was started with
  std::uint8_t number = 0;   ///< of the work frame
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< of the work frame, row by row
  Array3 origin_mm{};
  std::uint64_t sum = 0;     ///< stream::frame_sum()
  std::uint64_t tools = 0;   ///< stream::tools_sum()
  SoftLimits soft_limits{};  ///< as they were set
  SoftLimits travel{};       ///< travel_under() them
  std::uint64_t limits = 0;  ///< stream::limits_sum()
};
static_assert(std::is_trivially_copyable_v<SetUpInForce>);

/// Puts the workpiece of `model` where `set_up` says, and gives its joints the travel of it.
/// RT: cycle.
inline void apply_set_up(MachineModel& model, const SetUpInForce& set_up) noexcept {
  for (int i = 0; i < 9; ++i) {
    model.X_MW.rotation(i / 3, i % 3) = set_up.rotation[static_cast<std::size_t>(i)];
  }
  model.X_MW.origin_mm = to_vector(set_up.origin_mm);
  shrink_travel(model, set_up.travel);
}

/// What a command of verb `frame` says beside its Arrival.
struct FrameArrival {
  std::uint64_t key = 0;  ///< of the Arrival
  FrameOrder order{};
};

/// What a command of verb `tool` says beside its Arrival.
struct ToolArrival {
  std::uint64_t key = 0;  ///< of the Arrival
  std::uint64_t tools_seen = 0;
  std::array<char, dds::kToolFileBytes + 1> file{};  ///< zero-terminated
};

/// What a command of verb `limits` says beside its Arrival.
struct LimitsArrival {
  std::uint64_t key = 0;  ///< of the Arrival
  LimitsOrder order{};
};

/// The paths of the set-up. The commands thread stores it for the cycle, then commands it to read
/// it; when the cycle has accepted it, it stores it for the others and waits until the status
/// reports it. Everybody has a machine model and tools of its own, and changes them itself, between
/// two programs.
struct SetUpPorts {
  SpscRing<FrameArrival, 16> orders;    ///< receive thread to commands
  SpscRing<ToolArrival, 4> tool_files;  ///< receive thread to commands
  SpscRing<LimitsArrival, 16> limits;   ///< receive thread to commands
  LatestValue<SetUpInForce> for_cycle;  ///< the cycle looks where it accepts the verb
  LatestValue<SetUpInForce> for_planner, for_intake, for_telemetry;
  Mailbox<ToolTable> planner_tools, intake_tools, telemetry_tools;
  ProgramClaim claim;
  std::atomic<std::uint64_t> status{0};    ///< the first status with the newest set-up
  std::atomic<std::uint32_t> reported{0};  ///< its change; stored after `status`
};

}  // namespace meridian::interpolator
