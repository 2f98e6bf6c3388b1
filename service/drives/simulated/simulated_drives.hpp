// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/simulated/drive_group.hpp"
#include "service/transport/participant.hpp"

namespace meridian::drives {

struct SimulatedDrivesOptions {
  ServoLag lag;
  std::vector<HomingPlan> homing;  ///< in drive order; missing ones know where they are
  std::vector<Injection> injections;
  SpscRing<Injection, 64>* injections_now = nullptr;  ///< what somebody wants at once; may be none
  bool is_action_peer = true;                         ///< plays the PLC too
  bool is_refusing_actions = false;
  std::int64_t action_delay_ns = 200'000'000;
  bool has_priority = false;         ///< works at FIFO 65
  std::optional<ProbedPart> probed;  ///< a probe is in the spindle, and this in front of it
};

/// Real drives have processors of their own; these share them with everybody. Pins the calling
/// thread off the last CPU, which a service on this host uses for its cycle, so that DDS threads
/// inherit that. Returns whether there is a right to real-time threads.
[[nodiscard]] bool prepare_drive_priority();

/// For the word at the end.
struct SimulatedDrivesReport {
  std::uint64_t periods = 0, periods_lost = 0, setpoints_seen = 0, periods_bridged = 0;
  std::uint64_t actions = 0;
  drive::DropCounts dropped;
};

/// Puts a DriveGroup and an ActionPeer on the wire and works at the machine's cycle time until
/// `is_stopping`. Wake-ups keep phase; lost periods of this process are worked in one step. `say`
/// gets news for the operator: states of drives, actions; while it takes its time the drives stand
/// still (LineReporter). Takes bridge_cycles from the machine
/// topic where a service tells it. Throws DdsError at start.
SimulatedDrivesReport run_simulated_drives(dds::Participant& participant, const MachineModel& model,
                                           const SimulatedDrivesOptions& options,
                                           const std::atomic<bool>& is_stopping,
                                           const std::function<void(const std::string&)>& say);

}  // namespace meridian::drives
