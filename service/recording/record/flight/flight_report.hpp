// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/record_error.hpp"
#include "service/recording/record/file/recording_reader.hpp"

/// A recording with feedback looked at for what went wrong: `meridian record --read`.
/// Units: mm, rad, s; times from the alarm, or from the first row where there is none.
namespace meridian::record {

/// A drive that reports another state, or another error.
struct DriveTurn {
  int drive = 0;
  double at_s = 0;
  std::uint16_t from = 0, to = 0;  ///< statuswords
  std::uint16_t error = 0;
};

/// Feedback less the setpoint that it had seen, while the drives follow; largest of each stretch.
struct Following {
  double before = 0, at_alarm = 0, after = 0;
};

struct FlightReport {
  bool is_dry_run = false;  ///< the alarm is of one: no drive followed
  Alarm alarm = Alarm::kNone;
  int joint = -1;             ///< place in limited.hpp; -1: none
  std::uint64_t cycle = 0;    ///< of the alarm, or the first
  std::uint32_t line = 0;     ///< cut there
  std::uint64_t block = 0;    ///< the same
  State state = State::kOff;  ///< in the row in front of the alarm
  std::uint64_t rows = 0, missing = 0;
  double before_s = 0, after_s = 0;  ///< how far the recording reaches
  double stop_s = 0;                 ///< in FaultStop
  double emergency_at_s = 0;         ///< the input opened
  bool is_emergency = false;
  double oldest_feedback_s = 0, oldest_at_s = 0;
  std::array<Following, kMaxJoints> following;  ///< by drive
  static constexpr std::size_t kMaxTurns = 60;
  std::vector<DriveTurn> turns;  ///< the first of them
};

/// Reads the recording twice. It needs the feedback of every drive.
/// Proof: tests/unit/record/flight_test.cpp.
[[nodiscard]] Expected<FlightReport, RecordError> read_flight(RecordingReader& recording,
                                                              const MachineModel& model);

/// The report for a person.
[[nodiscard]] std::string to_text(const FlightReport& report, const MachineModel& model);

}  // namespace meridian::record
