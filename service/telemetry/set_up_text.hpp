// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "meridian/expected.hpp"
#include "meridian/kinematics/work_frame.hpp"

namespace meridian::telemetry {

/// No set-up is longer.
inline constexpr std::size_t kMostSetUpBytes = 16'384;

/// The set-up of `machine` as the text of its file: a line for each frame with its number, x, y, z
/// in mm, a, b, c in degrees and its name; every value comes back bit for bit.
[[nodiscard]] std::string to_text(const WorkFrames& frames, std::string_view machine);

/// Reads what to_text() wrote for `machine`. The error says in what the text is none.
/// Proof: tests/unit/telemetry/set_up_text_test.cpp.
[[nodiscard]] Expected<WorkFrames, std::string> parse_set_up(std::string_view text,
                                                             std::string_view machine);

/// "3 (vice)", "3", or "0 (machine file)".
[[nodiscard]] std::string frame_name(int number, const char* name);

/// Why a word about frame `number` is refused, and what to do.
[[nodiscard]] std::string describe(FrameFault fault, int number);

}  // namespace meridian::telemetry
