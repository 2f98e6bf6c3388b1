// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/record_error.hpp"

namespace meridian::ros {

struct ConversionReport {
  std::uint64_t rows = 0;
  std::uint64_t events = 0;  ///< of the rows, and of the file of events beside the recording
  std::uint64_t bytes = 0;   ///< of the MCAP file
  double length_s = 0;       ///< from the first row to the last
};

/// Writes the recording `in`, be it of the service, of the simulator, of `meridian record` or of
/// the flight recorder, with the events that lie beside it, as the MCAP file `out`. Where a row is
/// damaged `out` holds the rows before it.
/// Proof: tests/unit/ros/conversion_test.cpp, tests/mcap/read_test.mjs.
[[nodiscard]] Expected<ConversionReport, record::RecordError> convert(const std::string& in,
                                                                      const std::string& out,
                                                                      const MachineModel& model);

/// The report for a person.
[[nodiscard]] std::string to_text(const ConversionReport& report, const std::string& out);

}  // namespace meridian::ros
