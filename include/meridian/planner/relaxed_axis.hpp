// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

namespace meridian {

/// Why the tool axis was moved off the programmed one beside the pole, or beside the wrist
/// singularity of a robot. Over its base axis alone the axis stays.
enum class RelaxedReason : std::uint8_t {
  kThrough,  ///< straight through the pole, out on the other branch: the redundant joint hardly
             ///< turns
  kBeside,   ///< past it on the same branch, the redundant joint on a shorter course
  kOnPole,   ///< nearer than kPoleDeviation_rad: counts as on the pole, where no azimuth is defined
  kThroughWrist,  ///< of a 6R robot: out with the bend turned over, the roll hardly turns
  kPastWrist,     ///< with the bend as it was
  kThroughBoth,   ///< the same where the wrist point is over the base axis as well
  kPastBoth
};

/// A stretch of path on which the axis was moved beside a singularity, by blocks.
struct RelaxedAxis {
  std::uint64_t first_sequence = 0, last_sequence = 0;
  std::uint32_t first_line = 0, last_line = 0;
  double deviation_rad = 0;  ///< largest, from the programmed axis, smoothing included
  RelaxedReason reason = RelaxedReason::kOnPole;
};
static_assert(std::is_trivially_copyable_v<RelaxedAxis>);

/// In words, after "axis relaxed by ...: ".
[[nodiscard]] constexpr const char* name_of(RelaxedReason reason) noexcept {
  switch (reason) {
    case RelaxedReason::kThrough:
      return "through the pole";
    case RelaxedReason::kBeside:
      return "past the pole";
    case RelaxedReason::kOnPole:
      return "on the pole";
    case RelaxedReason::kThroughWrist:
      return "through the wrist singularity";
    case RelaxedReason::kPastWrist:
      return "past the wrist singularity";
    case RelaxedReason::kThroughBoth:
      return "through the wrist and shoulder singularities";
    case RelaxedReason::kPastBoth:
      return "past the wrist and shoulder singularities";
  }
  return "";
}

}  // namespace meridian
