// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "service/transport/convert/messages.hpp"

namespace meridian::test {

inline constexpr std::int64_t kMilli = 1'000'000;  ///< ns

/// What drive group `group` reports of the joints `mask`: all in operation enabled.
[[nodiscard]] inline dds::DriveFeedback sample(std::uint32_t group, std::uint32_t mask,
                                               std::uint64_t number) {
  dds::DriveFeedback feedback;
  feedback.drive_group = group;
  feedback.joint_mask = mask;
  feedback.sample = number;
  feedback.cycle_seen = 100 + number;
  for (std::size_t i = 0; i < kMaxJoints; ++i) {
    feedback.position[i] = 10.0 * group + static_cast<double>(i);
    feedback.statusword[i] = 0x27;
  }
  return feedback;
}

}  // namespace meridian::test
