// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "meridian/kinematics/soft_limits.hpp"

namespace meridian::record {

/// A row of the events beside a recording: `cycle,limits,joint,min,max`, the joint in machine order
/// from 1, mm or rad, or `cycle,keep_out,box,joint,min,max`, one for each joint of a keep-out box,
/// which counts from 1, or `cycle,tip_box,axis,min,max`, one for each of X, Y, Z from 1. The rows
/// of one cycle are all soft limits and boxes that are in force from it on; one of joint 0 stands
/// for none.
inline constexpr std::string_view kLimitsWord = "limits", kKeepOutWord = "keep_out",
                                  kTipBoxWord = "tip_box";

/// RecordedLimits::box of the tip box.
inline constexpr std::uint32_t kTipBoxNumber = KeepOut::kMax + 1;

struct RecordedLimits {
  std::uint64_t cycle = 0;
  std::uint32_t joint = 0;  ///< of the tip box: 1 X, 2 Y, 3 Z
  double min = 0, max = 0;
  std::uint32_t box = 0;  ///< 0: a soft limit; kTipBoxNumber
  [[nodiscard]] bool operator==(const RecordedLimits&) const = default;
};

/// The soft limits of one row; nothing where it is another row, or holds anything else.
[[nodiscard]] std::optional<RecordedLimits> read_limits(std::string_view row);
/// Whether a row is one of soft limits, whatever else it holds.
[[nodiscard]] bool is_limits_row(std::string_view row);

/// Soft limits that are in force from a cycle on, until others are.
struct LimitsFrom {
  std::uint64_t cycle = 0;
  SoftLimits limits{};
};

/// All soft limits that these events hold, in the order of their cycles.
[[nodiscard]] std::vector<LimitsFrom> find_all_limits(std::string_view events);

/// The soft limits that were in force when the first program of these events was started, or at
/// their end where none was; nothing where no row holds any.
/// Proof: tests/unit/record/recorded_limits_test.cpp.
[[nodiscard]] std::optional<SoftLimits> find_recorded_limits(std::string_view events);

}  // namespace meridian::record
