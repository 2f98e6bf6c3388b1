// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace meridian::record {

/// A feed override that an operator set, 1 is 100 %.
struct FeedOverride {
  std::uint64_t cycle = 0;
  double factor = 1;
};

/// Those in a file of operator events, in order; nothing where the file says that it lacks events.
[[nodiscard]] std::optional<std::vector<FeedOverride>> read_feed_overrides(std::string_view text);

/// What the feed override allows in a cycle: the largest that was in force in the `ramp` cycles up
/// to it, since the machine takes that long to follow; 1 before the first. Proof:
/// tests/unit/record/feed_overrides_test.cpp.
class FeedInForce {
 public:
  FeedInForce(std::vector<FeedOverride> set, std::uint64_t ramp)
      : set_(std::move(set)), ramp_(ramp) {}
  /// Cycles asked for go up.
  [[nodiscard]] double at(std::uint64_t cycle) noexcept;

 private:
  std::vector<FeedOverride> set_;
  std::uint64_t ramp_;
  std::size_t next_ = 0;  ///< first that is set later
};

}  // namespace meridian::record
