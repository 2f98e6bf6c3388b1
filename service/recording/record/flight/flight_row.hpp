// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "meridian/cycle/cycle_data.hpp"

/// What the flight recorder keeps of a cycle. Units: mm, rad.
namespace meridian::record {

/// What the drives said at one time, those of all groups together.
struct DriveReport {
  std::int64_t arrival_ns = 0;   ///< clock of Setpoint::due_ns; 0: never
  std::uint64_t cycle_seen = 0;  ///< newest setpoint that every group has taken
  JointVector position{};        ///< drive coordinates in drive order
  std::array<std::uint16_t, kMaxJoints> statusword{}, error{};  ///< CiA 402, 6041h and 603Fh
  std::uint32_t joint_mask = 0;                                 ///< drives that report
  bool is_emergency_stop = false;
};

/// A cycle that was sent, with the newest report that was there when it woke.
struct FlightRow {
  CycleRecord record;
  DriveReport drives;
};

/// An alarm as EventCode::kAlarm reports it.
struct ReportedAlarm {
  Alarm alarm = Alarm::kNone;
  int joint = 0;  ///< place in limited.hpp; 0 where the alarm is of no joint
  double value = 0;
  std::uint32_t line = 0;
  std::uint64_t cycle = 0;
};

static_assert(std::is_trivially_copyable_v<FlightRow>);

}  // namespace meridian::record
