// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/route_look_ahead.hpp"

#include <algorithm>

namespace meridian {

void RouteLookAhead::begin(double tool_length_mm, const ToolPose& start,
                           const LookAheadSlack& slack,
                           std::span<const RouteAhead> routes) noexcept {
  count_ = std::min(routes.size(), kMaxCandidates);
  std::copy_n(routes.begin(), count_, routes_.begin());
  followed_ = 0;
  for (int branch = 0; branch < kBranches; ++branch) {
    followers_[static_cast<std::size_t>(branch)].emplace(model_, tool_length_mm, slack, branch,
                                                         start, std::span(routes_.data(), count_));
  }
}

void RouteLookAhead::follow(const ClBlock& block) noexcept {
  ++followed_;
  for (auto& follower : followers_) {
    if (!follower->is_over()) follower->follow(block);
  }
}

bool RouteLookAhead::is_settled() const noexcept {
  const auto goes_on = [this](const RouteAhead& route) {
    return route.end == RouteEnd::kNone &&
           !followers_[static_cast<std::size_t>(route.branch)]->is_over();
  };
  return std::count_if(routes_.begin(), routes_.begin() + static_cast<std::ptrdiff_t>(count_),
                       goes_on) <= 1;
}

}  // namespace meridian
