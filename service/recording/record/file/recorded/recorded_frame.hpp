// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "meridian/geometry/vector3.hpp"

namespace meridian::record {

/// A row of the events beside a recording: `cycle,frame,number,` then the origin in mm and the
/// rotation row by row. From this cycle on the workpiece lies there.
inline constexpr std::string_view kFrameWord = "frame";

/// The work frame that a program was cut in, bit for bit.
struct RecordedFrame {
  std::uint64_t cycle = 0;
  std::uint8_t number = 0;  ///< of the set-up; 0: the machine file's, or --frame
  Array3 origin_mm{};
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
  [[nodiscard]] bool operator==(const RecordedFrame&) const = default;
};

/// The frame of one row; nothing where it is another row, or holds anything else.
[[nodiscard]] std::optional<RecordedFrame> read_frame(std::string_view row);
/// Whether a row is one of a frame, whatever else it holds.
[[nodiscard]] bool is_frame_row(std::string_view row);

/// The frame that was in force when the first program of these events was started, or at their end
/// where none was; nothing where no row holds one.
/// Proof: tests/unit/record/recorded_frame_test.cpp.
[[nodiscard]] std::optional<RecordedFrame> find_recorded_frame(std::string_view events);

}  // namespace meridian::record
