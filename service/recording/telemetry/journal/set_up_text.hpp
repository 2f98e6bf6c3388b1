// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "meridian/expected.hpp"
#include "meridian/kinematics/soft_limits.hpp"
#include "meridian/kinematics/work_frame.hpp"

namespace meridian::telemetry {

/// What is set at a machine beside its files.
struct SetUp {
  WorkFrames frames{};
  /// Text of the tool table, at most dds::kToolFileBytes; nothing: the service's own file counts.
  std::optional<std::string> tools{};
  SoftLimits limits{};
  [[nodiscard]] bool operator==(const SetUp&) const = default;
};

/// No set-up is longer.
inline constexpr std::size_t kMaxSetUpBytes = 24'576;

/// The set-up of `machine` as the text of its file: a line for each frame with its number, x, y, z
/// in mm, a, b, c in degrees and its name, one for each soft limit with its joint from 1, minimum
/// and maximum in mm or rad, one for each keep-out box with the mask of its joints, the minima and
/// maxima of all and its name, one for the tip box, then the tool table as it is; every value comes
/// back bit for bit.
[[nodiscard]] std::string to_text(const SetUp& set_up, std::string_view machine);

/// Reads what to_text() wrote for `machine`, this version's or one of before: the first knew no
/// tools, the second no soft limits, the third no boxes, the fourth no tip box. The error says in
/// what the text is none.
/// Proof: tests/unit/telemetry/set_up_text_test.cpp.
[[nodiscard]] Expected<SetUp, std::string> parse_set_up(std::string_view text,
                                                        std::string_view machine);

/// "3 (vice)", "3", or "0 (machine file)".
[[nodiscard]] std::string frame_name(int number, const char* name);

/// "tool 5, 110.05 mm long", or "the machine file's tool, 110 mm long".
[[nodiscard]] std::string tool_name(std::uint32_t number, double length_mm);

/// "soft limits X -10 to 200 mm, B -30 to 30 deg, keep-out box vice (X 1 to 2 mm), tip box (X 0
/// to 9 mm, Y 0 to 9 mm, Z 0 to 9 mm)"; of none: "no soft limits".
[[nodiscard]] std::string limits_text(const SoftLimits& limits, const MachineModel& model);

/// Why a word about the soft limits of a joint of `model` is refused, and what to do.
[[nodiscard]] std::string describe(LimitsFault fault, std::uint8_t joint,
                                   const MachineModel& model);

/// Why a word about frame `number` is refused, and what to do.
[[nodiscard]] std::string describe(FrameFault fault, int number);

}  // namespace meridian::telemetry
