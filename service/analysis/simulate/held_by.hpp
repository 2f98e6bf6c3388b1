// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "meridian/kinematics/limited.hpp"

/// What holds a motion back: a limit, and why the path runs into it there.
namespace meridian::simulate {

/// A limit by number: nothing, the programmed feed, the machine's highest feed, then velocity,
/// acceleration and jerk of everything in limited.hpp.
using LimitId = std::uint8_t;
inline constexpr LimitId kNoLimit = 0;
inline constexpr LimitId kFeedLimit = 1;
inline constexpr LimitId kMachineFeedLimit = 2;
inline constexpr std::size_t kLimitIds = 3 + 3 * static_cast<std::size_t>(kMaxLimited);

/// The limit of quantity `i` of limited.hpp; `order` 0 velocity, 1 acceleration, 2 jerk.
[[nodiscard]] constexpr LimitId joint_limit(int i, int order) noexcept {
  return static_cast<LimitId>(3 + 3 * i + order);
}
/// The other way round: the quantity, -1 where the limit is no joint's; and the order.
[[nodiscard]] constexpr int joint_of(LimitId id) noexcept { return id < 3 ? -1 : (id - 3) / 3; }
[[nodiscard]] constexpr int order_of(LimitId id) noexcept { return id < 3 ? 0 : (id - 3) % 3; }

/// How many limits a machine has, kNoLimit included.
[[nodiscard]] inline std::size_t limit_count(const MachineModel& model) noexcept {
  return 3 + 3 * static_cast<std::size_t>(limited_count(model));
}
/// "feed", "theta1 velocity", ... "none".
[[nodiscard]] std::string name_of(LimitId id, const MachineModel& model);

/// Why.
enum class Cause : std::uint8_t {
  kFeed,      ///< the feed itself: nothing is lost
  kPath,      ///< joints have that far to go on the way
  kBend,      ///< the path bends: a corner or a curve, here or where the motion brakes for it
  kPole,      ///< the redundant joint turns beside the pole
  kRest,      ///< the motion sets off from a rest or comes to one
  kOverride,  ///< the operator: an override below what was planned, a hold, a resume
  kWaiting,   ///< at rest: dwell, action, stop, hold, or blocks that did not come
  kRewind     ///< a joint ran out of travel: C is turned back, or over the pole, off the part
};
inline constexpr std::size_t kCauses = 8;
[[nodiscard]] const char* name_of(Cause cause) noexcept;

}  // namespace meridian::simulate
