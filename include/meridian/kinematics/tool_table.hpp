// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace meridian {

/// A tool of the magazine. Lengths from the gauge line of the spindle to the tip that CL files
/// mean. Unit: mm.
struct Tool {
  int number = 0;
  double length_mm = 0;  ///< as it was measured
  double radius_mm = 0;  ///< as it was measured
  double corner_radius_mm = 0;
  double length_wear_mm = 0;  ///< added to the length; negative: it has become shorter
  double radius_wear_mm = 0;  ///< added to the radius
  /// Outline of the holder: how far below the gauge line, and the radius there, downwards.
  std::vector<std::array<double, 2>> holder_mm{};

  /// Gauge line to tip as the machine uses it: wear included.
  [[nodiscard]] double tip_length_mm() const noexcept { return length_mm + length_wear_mm; }
  /// The radius that cuts: wear included.
  [[nodiscard]] double cutting_radius_mm() const noexcept { return radius_mm + radius_wear_mm; }
  [[nodiscard]] bool operator==(const Tool&) const = default;
};

/// The tools that a program may call. Immutable once it is built; find() may be called from any
/// thread.
class ToolTable {
 public:
  ToolTable() = default;

  /// Of tools with one number the first counts; the loader refuses doubles.
  explicit ToolTable(std::vector<Tool> tools) : tools_(std::move(tools)) {
    std::stable_sort(tools_.begin(), tools_.end(),
                     [](const Tool& a, const Tool& b) { return a.number < b.number; });
  }

  /// Returns the tool with `number`, or nullptr where the table has none.
  [[nodiscard]] const Tool* find(int number) const noexcept {
    const auto at = std::lower_bound(tools_.begin(), tools_.end(), number,
                                     [](const Tool& a, int n) { return a.number < n; });
    return at != tools_.end() && at->number == number ? &*at : nullptr;
  }

  [[nodiscard]] const std::vector<Tool>& tools() const noexcept { return tools_; }
  [[nodiscard]] bool operator==(const ToolTable&) const = default;

 private:
  std::vector<Tool> tools_;
};

}  // namespace meridian
