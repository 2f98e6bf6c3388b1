// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace meridian {

/// A tool of the magazine. Lengths from the gauge line of the spindle to the tip that CL files
/// mean. Unit: mm.
struct Tool {
  int number = 0;
  double length_mm = 0;
  double radius_mm = 0;
};

/// The tools that a program may call. Built at start-up, immutable after; find() may be called from
/// any thread.
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

 private:
  std::vector<Tool> tools_;
};

}  // namespace meridian
