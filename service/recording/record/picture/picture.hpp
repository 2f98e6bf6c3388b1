// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/path/checked_path.hpp"
#include "service/recording/record/file/record_error.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::record {

/// Draws a recording with gnuplot: tip path in space, joints, tip speed against the programmed
/// feed, velocity, acceleration and jerk of every joint against its limits. `file` ends in .png or
/// .svg.
///
/// Where the recording has more cycles than the picture has columns, each column shows the extremes
/// of its cycles, so that no peak is lost. `title` is put before machine and time. `path` gives the
/// programmed feed; it may be empty.
[[nodiscard]] std::optional<RecordError> draw(RecordingReader& recording, const CheckedPath& path,
                                              const MachineModel& model, const std::string& title,
                                              const std::string& file);

}  // namespace meridian::record
