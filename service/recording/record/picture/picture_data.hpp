// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/path/checked_path.hpp"
#include "service/recording/record/file/record_error.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::record {

/// Least and largest value of a column of the picture.
struct Extremes {
  double low = 0, high = 0;
  bool is_empty = true;

  void add(double value) noexcept {
    low = is_empty || value < low ? value : low;
    high = is_empty || value > high ? value : high;
    is_empty = false;
  }
};

/// The cycles that one column of the picture shows. Rates are in units of the joint's limit.
struct PictureColumn {
  double time_s = 0;
  std::array<Extremes, kMaxJoints> position;
  std::array<std::array<Extremes, kMaxJoints>, 3> rate;  ///< velocity, acceleration, jerk
  Extremes tip_speed_mm_per_s, feed_mm_per_s;
};

struct PictureData {
  std::vector<PictureColumn> columns;
  struct Point {
    Vector3 tip;
    Vector3 axis;  ///< of the tool, tip to shank
    MotionKind kind;
  };
  std::vector<Point> tip;  ///< in the workpiece frame
};

/// Reads the recording from the first to the last motion into at most `columns` columns.
[[nodiscard]] std::optional<RecordError> gather(RecordingReader& recording, const CheckedPath& path,
                                                const MachineModel& model, std::size_t columns,
                                                PictureData& data);

}  // namespace meridian::record
