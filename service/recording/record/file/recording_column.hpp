// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/recording_reader.hpp"

/// The columns of a recording as the reader knows them.
namespace meridian::record {

enum class Field : std::uint8_t {
  kSkip,
  kCycle,
  kDue,
  kLine,
  kKind,
  kPosition,
  kVelocity,
  kSequence,
  kState,
  kPlanTime,
  kRate,
  kEpoch,
  kFlags,
  kLateness,
  kComputation,
  kFeedback,
  kFeedbackCycle,
  kFeedbackAge,
  kStatusword,
  kDriveError,
  kEmergencyStop,
  kAlarm,
  kAlarmJoint
};

struct Column {
  Field field = Field::kSkip;
  int index = 0;  ///< in limited.hpp; of what drives report, the drive
  std::string name;
};

/// What a header's word names on this machine; kSkip where it is nothing that we know.
[[nodiscard]] Column find_column(std::string_view name, const MachineModel& model);

/// Puts what stands in `column` into the row; false where it is not of the column's kind. Numbers
/// are finite, but for the feedback: what drives say is kept as they said it. `names`: of
/// limited.hpp.
[[nodiscard]] bool read_field(const Column& column, std::string_view text,
                              const std::vector<std::string>& names, RecordingRow& row);

}  // namespace meridian::record
