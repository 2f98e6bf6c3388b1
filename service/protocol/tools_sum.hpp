// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/tool_table.hpp"
#include "service/text/checksum.hpp"

namespace meridian::stream {

/// By which station and service know that they mean the same tool table: FNV-1a, 64 bit, of all
/// that it says of every tool, as it lies in memory. Never 0.
/// Proof: tests/unit/protocol/tools_sum_test.cpp.
[[nodiscard]] inline std::uint64_t tools_sum(const ToolTable& tools) noexcept {
  text::Checksum sum;
  for (const Tool& tool : tools.tools()) {
    sum.add(static_cast<double>(tool.number));
    sum.add(tool.length_mm);
    sum.add(tool.radius_mm);
    sum.add(tool.corner_radius_mm);
    sum.add(tool.length_wear_mm);
    sum.add(tool.radius_wear_mm);
    sum.add(static_cast<double>(tool.holder_mm.size()));
    for (const auto& corner : tool.holder_mm) {
      for (const double value : corner) sum.add(value);
    }
  }
  return sum.sum();
}

}  // namespace meridian::stream
