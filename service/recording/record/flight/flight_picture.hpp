// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/record_error.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/flight/flight_report.hpp"

namespace meridian::record {

/// Draws what read_flight() looked at, with gnuplot: the drive that the alarm names (or that is
/// farthest off) as it was sent and as it reported, the following errors and the velocities of all
/// drives in shares of what is allowed. All of it at the left, the time around the alarm at the
/// right. `file` ends in .png or .svg. Proof: tests/unit/record/flight_test.cpp.
[[nodiscard]] std::optional<RecordError> draw_flight(RecordingReader& recording,
                                                     const FlightReport& report,
                                                     const MachineModel& model,
                                                     const std::string& file);

}  // namespace meridian::record
