// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/ahead_look.hpp"

#include <algorithm>

namespace meridian {

void AheadLook::begin(double tool_length_mm, const ToolPose& start, const AheadSlack& slack,
                      std::span<const AheadWay> ways) noexcept {
  count_ = std::min(ways.size(), kMaxWays);
  std::copy_n(ways.begin(), count_, ways_.begin());
  followed_ = 0;
  for (int branch = 0; branch < kBranches; ++branch) {
    followers_[static_cast<std::size_t>(branch)].emplace(model_, tool_length_mm, slack, branch,
                                                         start, std::span(ways_.data(), count_));
  }
}

void AheadLook::follow(const ClBlock& block) noexcept {
  ++followed_;
  for (auto& follower : followers_) {
    if (!follower->is_over()) follower->follow(block);
  }
}

bool AheadLook::is_settled() const noexcept {
  const auto goes_on = [this](const AheadWay& way) {
    return way.end == AheadEnd::kNone &&
           !followers_[static_cast<std::size_t>(way.branch)]->is_over();
  };
  return std::count_if(ways_.begin(), ways_.begin() + static_cast<std::ptrdiff_t>(count_),
                       goes_on) <= 1;
}

}  // namespace meridian
