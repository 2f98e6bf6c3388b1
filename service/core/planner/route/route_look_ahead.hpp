// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "service/core/planner/route/route_follower.hpp"

namespace meridian {

/// How many blocks each of some routes on carries, found block by block, for who waits for them: as
/// long as no joint and no drive of a stage is outside its travel (RouteFollower follows each
/// branch). The machine has a redundant joint. Bounded by the blocks, no memory. Units: mm, rad, s.
class RouteLookAhead {
 public:
  static constexpr std::size_t kMaxCandidates = 24;

  explicit RouteLookAhead(const MachineModel& model) noexcept : model_(model) {}

  /// `start`: the pose where all routes start; of the machine's routes the first kMaxCandidates are
  /// looked at.
  void begin(double tool_length_mm, const ToolPose& start, const LookAheadSlack& slack,
             std::span<const RouteAhead> routes) noexcept;
  /// The next block behind `start`; one that starts there, where it is an arc.
  void follow(const ClBlock& block) noexcept;

  /// No block to come can change which routes carry farthest: one alone goes on, or none.
  [[nodiscard]] bool is_settled() const noexcept;
  [[nodiscard]] int followed() const noexcept { return followed_; }
  [[nodiscard]] std::span<const RouteAhead> routes() const noexcept {
    return {routes_.data(), count_};
  }

 private:
  static constexpr int kBranches = 2;  ///< of a machine with a redundant joint

  const MachineModel& model_;
  std::array<RouteAhead, kMaxCandidates> routes_{};
  std::size_t count_ = 0;
  std::array<std::optional<RouteFollower>, kBranches> followers_;
  int followed_ = 0;
};

}  // namespace meridian
