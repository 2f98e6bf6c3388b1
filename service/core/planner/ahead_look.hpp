// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "service/core/planner/ahead_follower.hpp"

namespace meridian {

/// look_ahead() block by block, for a look that waits for blocks: how many each of some ways
/// carries, as far as blocks came. The machine has a free joint. Units: mm, rad. No memory.
class AheadLook {
 public:
  static constexpr std::size_t kMostWays = 24;

  explicit AheadLook(const MachineModel& model) noexcept : model_(model) {}

  void begin(double tool_length_mm, const ToolPose& start, const AheadSlack& slack,
             std::span<const AheadWay> ways) noexcept;
  void follow(const ClBlock& block) noexcept;

  /// No block to come can change which ways carry farthest: one alone goes on, or none.
  [[nodiscard]] bool is_settled() const noexcept;
  [[nodiscard]] int followed() const noexcept { return followed_; }
  [[nodiscard]] std::span<const AheadWay> ways() const noexcept { return {ways_.data(), count_}; }

 private:
  static constexpr int kBranches = 2;  ///< of a machine with a free joint

  const MachineModel& model_;
  std::array<AheadWay, kMostWays> ways_{};
  std::size_t count_ = 0;
  std::array<std::optional<AheadFollower>, kBranches> followers_;
  int followed_ = 0;
};

}  // namespace meridian
