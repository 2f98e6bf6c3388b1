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
  const auto add = [&sum](double value) {
    sum.add({reinterpret_cast<const char*>(&value), sizeof value});
  };
  for (const Tool& tool : tools.tools()) {
    add(tool.number);
    add(tool.length_mm);
    add(tool.radius_mm);
    add(tool.corner_radius_mm);
    add(tool.length_wear_mm);
    add(tool.radius_wear_mm);
    add(static_cast<double>(tool.holder_mm.size()));
    for (const auto& corner : tool.holder_mm) {
      for (const double value : corner) add(value);
    }
  }
  return sum.sum();
}

}  // namespace meridian::stream
